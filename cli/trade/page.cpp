#include "trade/page.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "trade/picture.hpp"
#include "trade/plot.hpp"

namespace isophote::cli {
namespace {

constexpr const char* kStyle = R"(
:root { color-scheme: light dark; --ink: #1d2126; --quiet: #667080; --line: #d9dde3; --ground: #fff; --panel: #f5f6f8;
  --a: #2457c5; --b: #c2410c; --c: #15803d; --d: #7e22ce; --e: #0e7490; --f: #a16207; --bad: #b91c1c; }
@media (prefers-color-scheme: dark) { :root { --ink: #e6e8eb; --quiet: #98a2b0; --line: #383d45; --ground: #16181b;
  --panel: #1f2226; --a: #7aa5ff; --b: #ff9a62; --c: #5fd18a; --d: #c99bff; --e: #5cc8dd; --f: #e3b341; --bad: #ff7b72; } }
body { font: 15px/1.5 system-ui, sans-serif; color: var(--ink); background: var(--ground); max-width: 1240px;
  margin: 2rem auto; padding: 0 1.2rem; }
h1 { font-size: 1.6rem; margin: 0 0 .3rem } h2 { font-size: 1.15rem; margin: 2.2rem 0 .6rem }
p, li { max-width: 78ch } .quiet { color: var(--quiet) } .bad { color: var(--bad) } .good { color: var(--c) }
code { font: 13px ui-monospace, monospace; overflow-wrap: anywhere }
.cards { display: grid; grid-template-columns: repeat(auto-fit, minmax(300px, 1fr)); gap: 1rem }
.card { background: var(--panel); border: 1px solid var(--line); border-radius: 8px; padding: .8rem 1rem }
.card h3 { margin: 0 0 .3rem; font-size: 1rem } .card code { display: block; margin: .5rem 0 }
.wide { overflow-x: auto } table { border-collapse: collapse; font-variant-numeric: tabular-nums }
th, td { text-align: right; padding: .35rem .55rem; border-bottom: 1px solid var(--line); vertical-align: middle }
th:first-child, td:first-child { text-align: left } th { font-weight: 600; vertical-align: bottom }
td small { color: var(--quiet); display: block; white-space: nowrap }
img { image-rendering: pixelated; width: 112px; display: block; border: 1px solid var(--line) } .large img { width: 384px }
svg { width: 100%; max-width: 860px; background: var(--panel); border: 1px solid var(--line); border-radius: 8px }
.grid { stroke: var(--line); fill: none } .tick { fill: var(--quiet); font: 11px system-ui, sans-serif }
.middle { text-anchor: middle } .end { text-anchor: end } .line { fill: none; stroke-width: 1.8 }
.whisker { stroke-width: 1; opacity: .7 } .mark { stroke: var(--panel) }
.s0 { stroke: var(--a) } .s1 { stroke: var(--b) } .s2 { stroke: var(--c) } .s3 { stroke: var(--d) } .s4 { stroke: var(--e) }
.s5 { stroke: var(--f) } .other { stroke: var(--quiet) } .front { stroke: var(--ink); stroke-dasharray: 4 3; stroke-width: 1.2 }
circle.s0, text.s0 { fill: var(--a); stroke: none } circle.s1, text.s1 { fill: var(--b); stroke: none }
circle.s2, text.s2 { fill: var(--c); stroke: none } circle.s3, text.s3 { fill: var(--d); stroke: none }
circle.s4, text.s4 { fill: var(--e); stroke: none } circle.s5, text.s5 { fill: var(--f); stroke: none }
circle.other, text.other { fill: var(--quiet); stroke: none }
)";

constexpr size_t kColors = 6;
constexpr float kFullDifference = 0.25f;

std::string percent(double share) { return std::isfinite(share) ? fmt::format("{:.3g}%", 100 * share) : "unknown"; }

std::string timeText(double seconds) {
  if (!std::isfinite(seconds)) return "never";
  if (seconds < 1e-3) return fmt::format("{:.3g} µs", 1e6 * seconds);
  if (seconds < 1) return fmt::format("{:.3g} ms", 1e3 * seconds);
  if (seconds < 120) return fmt::format("{:.3g} s", seconds);
  if (seconds < 7200) return fmt::format("{:.3g} min", seconds / 60);
  return fmt::format("{:.3g} h", seconds / 3600);
}

/// A value with its interval below.
std::string cell(const std::string& value, const std::string& interval) {
  return fmt::format("<td>{}<small>{}</small></td>", value, interval);
}

std::string ratioCell(const Interval& ratio) {
  if (!std::isfinite(ratio.value)) return "<td>none</td>";
  const char* verdict = ratio.upper < 1 ? "good" : ratio.lower > 1 ? "bad" : "";
  return fmt::format("<td class='{}'>{:.3g}<small>{:.3g} to {:.3g}</small></td>", verdict, ratio.value, ratio.lower,
                     ratio.upper);
}

std::string biasCell(const ErrorSplit& split, bool seen) {
  const std::string value = seen ? percent(rootOf(split.biasSquare.value)) : "none seen";
  return fmt::format("<td class='{}'>{}<small>below {}</small></td>", seen ? "bad" : "", value,
                     percent(rootOf(split.biasSquare.upper)));
}

class Page {
public:
  Page(const Study& study, const StudyContext& context) : study_(study), context_(context) {}

  std::string write() {
    html_ += "<!doctype html>\n<html lang='en'><head><meta charset='utf-8'><meta name='viewport' "
             "content='width=device-width'>";
    html_ += fmt::format("<title>Trade: {}</title><style>{}</style></head><body>\n", escaped(context_.scene), kStyle);
    introduction();
    if (study_.exact().measured()) {
      recommendations();
      if (!(study_.tradeOff(0).cost > 0)) html_ += "<p>The exact settings have no noise here.</p>\n";
    }
    if (study_.exact().measured() && study_.tradeOff(0).cost > 0) {
      html_ += "<h2>Error against time</h2>\n" + errorPlot();
      html_ +=
          "<p class='quiet'>Relative RMS error, noise and bias together, of the exact settings and of what no other "
          "way beats at every time. Marks are the measured runs; lines follow from them: noise falls as one over the "
          "root of the time, bias stays (at its upper bound).</p>\n";
      html_ += "<h2>Price and bias</h2>\n" + frontPlot();
      html_ += "<p class='quiet'>Each way to render by the time it takes to the same noise, and by its bias. Whiskers: "
               "95% intervals. Dashed: the Pareto front. Below and left is better.</p>\n";
      table("One setting at a time", singles());
      table("Combinations", combinations());
      table("The denoised layer", denoised());
      aboutDenoised();
    }
    leftOut();
    method();
    html_ += "</body></html>\n";
    return std::move(html_);
  }

private:
  void introduction() {
    const Reference& reference = study_.reference;
    html_ += fmt::format(
        "<h1>What each setting costs and gains</h1>\n<p><code>{}</code>, {} x {} pixels, on {} ({}).</p>\n",
        escaped(context_.scene), context_.width, context_.height, escaped(context_.device), escaped(context_.driver));
    if (study_.interrupted) html_ += "<p class='bad'>Interrupted: this is what was measured until then.</p>\n";
    if (reference.image.channels.empty()) return;
    html_ += fmt::format("<p>{} runs of {} samples a pixel in {}. Reference: {}, error {}", runCount(),
                         study_.samplesPerRun, timeText(study_.seconds),
                         reference.samples > 0 ? fmt::format("{} samples a pixel", reference.samples)
                                               : escaped(reference.source),
                         percent(rootOf(reference.square)));
    if (reference.untrustedShare > 0)
      html_ += fmt::format(", {} of its pixels not to be trusted", percent(reference.untrustedShare));
    html_ += ".";
    if (!reference.goodEnough) {
      html_ +=
          " <span class='bad'>That is not good enough for the question: a bias as large as this error cannot be told "
          "from it. A larger --budget, or a --reference, would do.</span>";
    }
    if (study_.exact().measured()) {
      html_ +=
          fmt::format(" The least bias that can be seen here is about {}.",
                      percent(rootOf(study_.exact().split.biasSquare.upper - study_.exact().split.biasSquare.value)));
      if (study_.biasSeen(study_.exact()))
        html_ += " <span class='bad'>The exact settings show another image than the reference: it was made of another "
                 "scene, camera or environment, or holds a bright event that they have not seen.</span>";
    }
    html_ += "</p>\n<div class='large'>" +
             pictureTag(reference.image, middleExposure(reference.image), "The reference") + "</div>\n";
  }

  [[nodiscard]] size_t runCount() const {
    size_t count = 0;
    for (const Measurement& m : study_.measurements) count += m.runs.size();
    return count;
  }

  void recommendations() {
    html_ += "<h2>Recommended</h2>\n<div class='cards'>\n";
    for (const Recommendation& r : study_.recommendations) {
      const Measurement& m = study_.measurements[r.measurement];
      html_ +=
          fmt::format("<div class='card'><h3>{}: {} error</h3>{}<code>{}</code>", r.purpose, percent(r.targetError),
                      escaped(m.configuration.name()), escaped(commandLine(study_, r, context_)));
      html_ += fmt::format("<div>Forecast for {} x {} pixels: {}; with the exact settings {}.</div>", context_.width,
                           context_.height, timeText(r.seconds),
                           timeText(secondsToError(study_.tradeOff(0), r.targetError)));
      confirmation(r);
      html_ += "</div>\n";
    }
    html_ += "</div>\n";
  }

  void confirmation(const Recommendation& r) {
    if (!r.tried()) {
      html_ += "<div class='quiet'>Not confirmed: no time was left.</div>";
      return;
    }
    html_ +=
        fmt::format("<div class='{}'>{} by {} fresh seeds of {} samples: error {} ({} to {}), forecast {}; {} each, "
                    "forecast {}.</div>",
                    r.confirmed() ? "good" : "bad", r.confirmed() ? "Confirmed" : "Not confirmed", r.found.runs,
                    r.confirmedSamples, percent(rootOf(r.found.totalSquare.value)),
                    percent(rootOf(r.found.totalSquare.lower)), percent(rootOf(r.found.totalSquare.upper)),
                    percent(r.forecastError), timeText(r.foundSeconds.value), timeText(r.forecastSeconds));
  }

  /// The exact settings, what is recommended and the front, each with its color; at most as many as there are colors.
  [[nodiscard]] std::vector<size_t> shown() const {
    std::vector<size_t> list = {0};
    const auto show = [&](size_t i) {
      if (list.size() < kColors && std::find(list.begin(), list.end(), i) == list.end()) list.push_back(i);
    };
    for (const Recommendation& r : study_.recommendations) show(r.measurement);
    for (const size_t i : study_.front) show(i);
    return list;
  }

  std::string errorPlot() {
    const std::vector<size_t> ways = shown();
    const double slowest = secondsToError(study_.tradeOff(0), 0.01);
    const double fastest = study_.exact().seconds().value / 8;
    const double from = std::min(fastest, secondsToError(study_.tradeOff(0), 0.3));
    const double to = std::max(slowest, 10 * fastest);
    double high = 0.1, low = 1e-3;
    for (const size_t i : ways) high = std::max(high, errorAfter(study_.tradeOff(i), from));
    low = std::max(low, 0.7 * errorAfter(study_.tradeOff(0), to));
    Plot plot({.label = "seconds", .from = from, .to = to, .logarithmic = true},
              {.label = "relative RMS error", .from = low, .to = high, .logarithmic = true, .percent = true});
    for (size_t w = 0; w < ways.size(); ++w) {
      const Measurement& m = study_.measurements[ways[w]];
      const std::string style = fmt::format("s{}", w);
      std::vector<Plot::Point> points;
      for (int step = 0; step <= 60; ++step) {
        const double seconds = from * std::pow(to / from, step / 60.0);
        points.push_back({seconds, errorAfter(study_.tradeOff(ways[w]), seconds)});
      }
      plot.line(points, style, m.configuration.name());
      // Of the exact settings' time the share that runs side by side found, as for the lines.
      const double seconds = study_.exact().seconds().value * priceOf(m, study_.exact()).seconds.value;
      const double error = rootOf(m.split.totalSquare.value);
      plot.mark({seconds, error}, style,
                fmt::format("{}: {} after {}", m.configuration.name(), percent(error), timeText(seconds)));
    }
    return "<div>" + plot.svg() + "</div>\n" + legend(ways);
  }

  std::string legend(const std::vector<size_t>& ways) const {
    std::string text = "<p>";
    for (size_t w = 0; w < ways.size(); ++w) {
      text +=
          fmt::format("<svg viewBox='0 0 12 12' style='width:12px;border:0;background:none'><circle class='s{}' cx='6' "
                      "cy='6' r='5'/></svg> {} &ensp; ",
                      w, escaped(study_.measurements[ways[w]].configuration.name()));
    }
    return text + "</p>\n";
  }

  std::string frontPlot() {
    const std::vector<size_t> colored = shown();
    const double exactCost = study_.tradeOff(0).cost;
    double least = 0.8, most = 1.25, highest = 0.01;
    for (size_t i = 0; i < study_.measurements.size(); ++i) {
      const Measurement& m = study_.measurements[i];
      if (!m.measured() || m.configuration.denoised()) continue;
      const double cost = study_.tradeOff(i).cost / exactCost;
      if (cost > 0 && std::isfinite(cost)) { // a way without noise has no place on the axis
        least = std::min(least, 0.8 * cost);
        most = std::max(most, 1.25 * cost);
      }
      highest =
          std::max({highest, 1.3 * rootOf(m.split.biasSquare.value), 1.1 * std::sqrt(study_.tradeOff(i).biasSquare)});
    }
    Plot plot({.label = "time to the same noise, over that of the exact settings",
               .from = least,
               .to = most,
               .logarithmic = true},
              {.label = "RMS bias", .from = 0, .to = highest, .percent = true});
    std::vector<Plot::Point> front;
    for (const size_t i : study_.front) {
      const TradeOff way = study_.tradeOff(i);
      const Plot::Point point{way.cost / exactCost, std::sqrt(way.biasSquare)};
      if (!front.empty()) front.push_back({point.x, front.back().y});
      front.push_back(point);
    }
    plot.line(front, "front", "Pareto front");
    for (size_t i = 0; i < study_.measurements.size(); ++i) markWay(plot, i, colored, exactCost);
    return "<div>" + plot.svg() + "</div>\n" + legend(colored);
  }

  void markWay(Plot& plot, size_t index, const std::vector<size_t>& colored, double exactCost) const {
    const Measurement& m = study_.measurements[index];
    if (!m.measured() || m.configuration.denoised()) return;
    const auto place = std::find(colored.begin(), colored.end(), index);
    const std::string style = place == colored.end() ? "other" : fmt::format("s{}", place - colored.begin());
    const Price price = priceOf(m, study_.exact());
    const double cost = study_.tradeOff(index).cost / exactCost;
    const double bias = rootOf(m.split.biasSquare.value);
    plot.whisker({price.cost.lower, bias}, {price.cost.upper, bias}, style);
    plot.whisker({cost, rootOf(m.split.biasSquare.lower)}, {cost, rootOf(m.split.biasSquare.upper)}, style);
    const bool labelled = study_.biasSeen(m) && m.configuration.changes.size() < 2;
    plot.mark({cost, bias}, style,
              fmt::format("{}: {:.3g} of the time, bias {}", m.configuration.name(), cost, percent(bias)),
              labelled ? m.configuration.name() : "");
  }

  template <class Wanted> [[nodiscard]] std::vector<size_t> measured(const Wanted& wanted) const {
    std::vector<size_t> list;
    for (size_t i = 0; i < study_.measurements.size(); ++i) {
      if (study_.measurements[i].measured() && wanted(study_.measurements[i].configuration)) list.push_back(i);
    }
    return list;
  }

  [[nodiscard]] std::vector<size_t> singles() const {
    return measured([](const Configuration& c) { return c.changes.size() < 2 && !c.denoised(); });
  }

  /// The fastest first.
  [[nodiscard]] std::vector<size_t> combinations() const {
    std::vector<size_t> list = measured([](const Configuration& c) { return c.changes.size() >= 2; });
    std::sort(list.begin(), list.end(),
              [&](size_t a, size_t b) { return study_.tradeOff(a).cost < study_.tradeOff(b).cost; });
    return list;
  }

  [[nodiscard]] std::vector<size_t> denoised() const {
    return measured([](const Configuration& c) { return c.denoised(); });
  }

  void table(const std::string& title, const std::vector<size_t>& rows) {
    if (rows.empty()) return;
    html_ +=
        fmt::format("<h2>{}</h2>\n<div class='wide'><table><tr><th>settings</th><th>time per sample<br>× exact</th>"
                    "<th>noise²<br>× exact</th><th>time to same noise<br>× exact</th><th>noise RMS<br>of a run</th>"
                    "<th>bias RMS</th><th>brightness</th><th>mean of the runs</th><th>difference<br>to reference</th>"
                    "</tr>\n",
                    title);
    for (const size_t i : rows) row(i);
    html_ += "</table></div>\n";
  }

  void row(size_t index) {
    const Measurement& m = study_.measurements[index];
    const Price price = priceOf(m, study_.exact());
    const ErrorSplit& split = m.split;
    const bool seen = study_.biasSeen(m);
    html_ += fmt::format(
        "<tr><td><code>{}</code><small>{} runs of {}{}{}</small></td>", escaped(m.configuration.name()), m.runs.size(),
        timeText(m.seconds().value), m.declaredUnbiased ? "" : ", declared as biased",
        std::find(study_.front.begin(), study_.front.end(), index) != study_.front.end() ? ", on the front" : "");
    if (m.configuration.exact()) {
      html_ += "<td>1</td><td>1</td><td>1</td>";
    } else {
      html_ += ratioCell(price.seconds) + ratioCell(price.noise) + ratioCell(price.cost);
    }
    html_ +=
        cell(percent(rootOf(split.noiseSquare.value)), fmt::format("{} to {}", percent(rootOf(split.noiseSquare.lower)),
                                                                   percent(rootOf(split.noiseSquare.upper))));
    html_ += biasCell(split, seen);
    html_ += cell(fmt::format("{:+.3g}%", 100 * split.brightness.value),
                  fmt::format("{:+.3g} to {:+.3g}%", 100 * split.brightness.lower, 100 * split.brightness.upper));
    const std::string name = m.configuration.name();
    html_ += fmt::format("<td>{}</td><td>{}</td></tr>\n",
                         pictureTag(m.splitter->meanImage(), middleExposure(study_.reference.image), name),
                         differenceTag(m.splitter->differenceImage(), kFullDifference, name + ", relative difference"));
    if (seen && m.declaredUnbiased && !m.configuration.exact()) {
      html_ +=
          "<tr><td colspan='9' class='bad'>This setting should not change the image's expectation, but differs from "
          "the reference: a rare bright event, or a bug.</td></tr>\n";
    }
  }

  void aboutDenoised() {
    if (denoised().empty()) return;
    html_ += fmt::format(
        "<p class='quiet'>What a filter makes of the exact image of {} samples, beside it. It has no error bars: its "
        "noise is from how its runs differ. Noise and bias both fall with the samples, so that it has no place in the "
        "plots and is not recommended; whether it helps is told by noise² and bias² together, here {:.3g} of the exact "
        "image's noise².</p>\n",
        study_.samplesPerRun, denoisedShare());
  }

  /// Mean square of the denoised layer's error, noise and bias together, over that of the image.
  [[nodiscard]] double denoisedShare() const {
    return study_.measurements[denoised().front()].split.totalSquare.value / study_.exact().split.totalSquare.value;
  }

  void leftOut() {
    std::string none, refused, missing;
    for (const Measurement& m : study_.measurements) {
      const std::string name = "<code>" + escaped(m.configuration.name()) + "</code>";
      if (m.state == MeasurementState::NoEffect) none += (none.empty() ? "" : ", ") + name;
      if (m.state == MeasurementState::Refused) refused += "<li>" + name + ": " + escaped(m.reason) + "</li>";
      if (m.state == MeasurementState::Planned) missing += (missing.empty() ? "" : ", ") + name;
    }
    if ((none + refused + missing).empty()) return;
    html_ += "<h2>Not in the tables</h2>\n<ul>";
    if (!none.empty()) html_ += "<li>The same image to the last bit, so neither price nor gain here: " + none + "</li>";
    html_ += refused;
    if (!missing.empty()) html_ += "<li>No time was left for: " + missing + "</li>";
    html_ += "</ul>\n";
  }

  void method() {
    html_ += fmt::format(
        "<h2>How this was measured</h2>\n<ul>"
        "<li>Errors are relative: a pixel's difference over the root of its squared reference value plus the square of "
        "1% "
        "of the mean luminance; RMS over pixels and channels.</li>"
        "<li>Noise is from the spread of the eight independent replicates of each run. Bias is from products of the "
        "differences of different seeds to the reference, less the reference's own squared error, so that neither "
        "noise "
        "counts as bias. A bias is \"seen\" where noise would pretend one in less than 1% of such studies.</li>"
        "<li>Brightness: how much brighter all pixels together are than in the reference.</li>"
        "<li>Runs of all settings are made in turn and compared within a round, so that what disturbs the machine "
        "disturbs "
        "all alike. Compilation of kernels ({} in all) is not part of the times.</li>"
        "<li>Pictures of differences: red is too bright, blue too dark, full color at {}.</li>"
        "<li>Times are for {} x {} pixels; they grow with the number of pixels, errors do not.</li></ul>\n",
        timeText(study_.compileSeconds), percent(double(kFullDifference)), context_.width, context_.height);
  }

  const Study& study_;
  const StudyContext& context_;
  std::string html_;
};

} // namespace

std::string studyPage(const Study& study, const StudyContext& context) { return Page(study, context).write(); }

} // namespace isophote::cli
