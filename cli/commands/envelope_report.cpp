#include "commands/envelope_report.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "trade/plot.hpp"

namespace isophote::cli {
namespace {

using Json = nlohmann::ordered_json;
using envelope::Point;
using envelope::Range;

constexpr double kLimits[] = {1e-3, 1e-2};
constexpr double kLeastShown = 1e-8, kMostShown = 1;

constexpr const char* kStyle =
    "svg{background:#fff;font:11px system-ui,sans-serif}.grid{stroke:#e3e6ea;fill:none}.tick{fill:#556}"
    ".middle{text-anchor:middle}.end{text-anchor:end}.line{fill:none;stroke-width:1.6;stroke:#2457c5}"
    ".limit{stroke:#15803d;stroke-dasharray:5 "
    "4;stroke-width:1.2}text.limit{stroke:none;fill:#15803d}circle.limit{display:none}"
    ".whisker{stroke:#2457c5;opacity:.6}circle.mark{fill:#2457c5}circle.bad{fill:#b91c1c}text.bad{fill:#b91c1c}";

/// `1e-08` as 1e-8.
std::string shortExponent(const std::string& text) {
  const size_t exponent = text.find('e');
  if (exponent == std::string::npos) return text;
  return fmt::format("{}e{}", text.substr(0, exponent), std::stoi(text.substr(exponent + 1)));
}

/// Short: 1e-8, 16384, 2^20, 1+1e-6.
std::string number(double value) {
  const double power = value > 0 ? std::log2(value) : 0.5;
  if (power == std::round(power) && (power <= -5 || power >= 17)) return fmt::format("2^{:.0f}", power);
  if (std::abs(value - 1) < 1e-3 && value != 1) return shortExponent(fmt::format("1{:+.0e}", value - 1));
  return shortExponent(fmt::format("{:.5g}", value));
}

std::string rangeText(const Range& range) {
  if (!range.any) return "nowhere";
  if (range.fromStart && range.toEnd) return fmt::format("**{} to {}**, all", number(range.first), number(range.last));
  return fmt::format("{} to {}", number(range.first), number(range.last));
}

Json rangeJson(const Range& range) {
  if (!range.any) return nullptr;
  return {{"first", range.first}, {"last", range.last}, {"whole", range.fromStart && range.toEnd}};
}

/// The largest error there is beyond doubt, in percent.
std::string percent(double share) {
  if (!std::isfinite(share)) return "failed";
  return share < 0.995 ? shortExponent(fmt::format("{:.2g}", 100 * share)).append("%")
                       : fmt::format("{:.0f}%", 100 * share);
}

} // namespace

nlohmann::ordered_json envelopeJson(const std::vector<MeasuredSweep>& sweeps, const EnvelopeContext& context) {
  Json list = Json::array();
  for (const MeasuredSweep& measured : sweeps) {
    Json points = Json::array();
    for (const Point& p : measured.points) {
      Json point = {{"value", p.value}, {"samples", p.samples}, {"seconds", p.seconds}};
      point["error"] = p.failure.empty() ? Json(p.error) : Json(nullptr);
      point["half_width"] = p.failure.empty() ? Json(p.halfWidth) : Json(nullptr);
      if (!p.failure.empty()) point["failure"] = p.failure;
      points.push_back(std::move(point));
    }
    list.push_back({{"name", measured.sweep.name},
                    {"quantity", measured.sweep.quantity},
                    {"scene", measured.sweep.scene},
                    {"below_0.1_percent", rangeJson(rangeBelow(measured.sweep, measured.points, kLimits[0]))},
                    {"below_1_percent", rangeJson(rangeBelow(measured.sweep, measured.points, kLimits[1]))},
                    {"points", std::move(points)}});
  }
  return {{"schema", 1},
          {"command", context.command},
          {"device", context.device},
          {"driver", context.driver},
          {"seconds", context.seconds},
          {"interrupted", context.interrupted},
          {"sweeps", std::move(list)}};
}

std::vector<MeasuredSweep> measuredBefore(const std::string& json, const std::vector<envelope::Sweep>& all) {
  std::vector<MeasuredSweep> result;
  try {
    const Json read = Json::parse(json);
    for (const Json& entry : read.at("sweeps")) {
      const auto sweep = std::find_if(all.begin(), all.end(), [&](const envelope::Sweep& s) {
        return s.name == entry.at("name").get<std::string>();
      });
      if (sweep == all.end()) continue;
      MeasuredSweep& measured = result.emplace_back(MeasuredSweep{*sweep});
      for (const Json& p : entry.at("points")) {
        Point& point = measured.points.emplace_back();
        point.value = p.at("value");
        point.samples = p.at("samples");
        point.seconds = p.at("seconds");
        point.failure = p.value("failure", std::string());
        if (!point.failure.empty()) continue;
        point.error = p.at("error");
        point.halfWidth = p.at("half_width");
      }
    }
  } catch (const Json::exception&) {
    return {};
  }
  return result;
}

std::string envelopeCsv(const std::vector<MeasuredSweep>& sweeps) {
  std::string text = "sweep,value,error,half_width,samples,seconds,failure\n";
  for (const MeasuredSweep& measured : sweeps) {
    for (const Point& p : measured.points) {
      std::string failure = p.failure;
      std::replace(failure.begin(), failure.end(), ',', ';');
      text += fmt::format("{},{:.9g},{:.4g},{:.4g},{},{:.3f},{}\n", measured.sweep.name, p.value, p.error, p.halfWidth,
                          p.samples, p.seconds, failure);
    }
  }
  return text;
}

std::string envelopeCurve(const MeasuredSweep& measured) {
  const std::vector<Point>& points = measured.points;
  Axis x{.label = measured.sweep.quantity, .from = -0.5, .to = static_cast<double>(points.size()) - 0.5};
  for (const Point& p : points) x.names.push_back(number(p.value));
  Plot plot(x, {.label = "relative error", .from = kLeastShown, .to = kMostShown, .logarithmic = true});
  for (const double limit : kLimits) {
    plot.line({{x.from, limit}, {x.to, limit}}, "limit");
    plot.mark({x.to, limit}, "limit", "", fmt::format("{:g}%", 100 * limit));
  }
  std::vector<Plot::Point> curve;
  for (size_t i = 0; i < points.size(); ++i) {
    const Point& p = points[i];
    const double at = static_cast<double>(i);
    if (!p.failure.empty()) {
      plot.mark({at, kMostShown}, "bad", p.failure, "failed");
      continue;
    }
    const double error = std::clamp(std::abs(p.error), kLeastShown, kMostShown);
    const double least = std::clamp(std::abs(p.error) - p.halfWidth, kLeastShown, kMostShown);
    plot.whisker({at, least}, {at, std::clamp(p.bound(), kLeastShown, kMostShown)}, "");
    plot.mark({at, error}, "", fmt::format("{}: {:.2e} +- {:.1e}", number(p.value), p.error, p.halfWidth));
    curve.push_back({at, error});
  }
  plot.line(curve, "");
  return plot.svgFile(kStyle);
}

std::string envelopePage(const std::vector<MeasuredSweep>& sweeps, const EnvelopeContext& context) {
  std::string text = "# Envelope\n\n";
  text +=
      fmt::format("How far each quantity can go before the image is wrong. Written by `{}` on {} ({}); its points took "
                  "{:.0f} s together.\n\n"
                  "Every image here has a known answer. An error counts as below a limit only where the upper end of "
                  "its 95% interval "
                  "is; the range is of the values measured, without a gap, around a tame one. Dashed lines in the "
                  "curves are 0.1% and "
                  "1%, whiskers the intervals; an error below 1e-8 is drawn there.\n\n",
                  context.command, context.device, context.driver, context.seconds);
  if (context.interrupted) text += "**Interrupted: this is what was measured until then.**\n\n";
  text += "| sweep | quantity | error below 0.1% | below 1% | largest bound |\n|---|---|---|---|---|\n";
  for (const MeasuredSweep& measured : sweeps) {
    double largest = 0;
    for (const Point& p : measured.points) largest = std::max(largest, p.bound());
    text += fmt::format("| [{0}](#{0}) | {1} | {2} | {3} | {4} |\n", measured.sweep.name, measured.sweep.quantity,
                        rangeText(rangeBelow(measured.sweep, measured.points, kLimits[0])),
                        rangeText(rangeBelow(measured.sweep, measured.points, kLimits[1])), percent(largest));
  }
  for (const MeasuredSweep& measured : sweeps) {
    text += fmt::format("\n## {0}\n\n{1}.\n\n![{0}]({0}.svg)\n", measured.sweep.name, measured.sweep.scene);
    for (const Point& p : measured.points) {
      if (!p.failure.empty()) text += fmt::format("\nAt {}: {}.\n", number(p.value), p.failure);
    }
  }
  return text;
}

} // namespace isophote::cli
