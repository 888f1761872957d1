#include "trade/plot.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace isophote::cli {
namespace {

constexpr double kWidth = 760, kHeight = 380; // of the drawing, in its own units
constexpr double kLeft = 70, kRight = 150, kTop = 14, kBottom = 48;

} // namespace

double Axis::position(double value) const {
  const double position =
      logarithmic ? std::log(std::max(value, from * 1e-3) / from) / std::log(to / from) : (value - from) / (to - from);
  return std::clamp(position, -0.05, 1.05);
}

std::vector<double> Axis::ticks() const {
  std::vector<double> ticks;
  for (size_t i = 0; i < names.size(); ++i) ticks.push_back(static_cast<double>(i));
  if (!names.empty()) return ticks;
  if (!(to > from) || !std::isfinite(to - from) || (logarithmic && !(from > 0))) return ticks;
  if (logarithmic) {
    // 1, 2, 5 of each decade; of long axes decades alone.
    const bool decades = std::log10(to / from) > 3;
    for (double decade = std::pow(10, std::floor(std::log10(from))); decade <= to; decade *= 10) {
      for (const double digit : {1.0, 2.0, 5.0}) {
        const double tick = digit * decade;
        if (tick >= from * 0.999 && tick <= to * 1.001 && (digit == 1 || !decades)) ticks.push_back(tick);
      }
    }
    return ticks;
  }
  const double rough = (to - from) / 5;
  const double decade = std::pow(10, std::floor(std::log10(rough)));
  const double digit = rough / decade;
  const double step = (digit < 1.5 ? 1 : digit < 3.5 ? 2 : digit < 7.5 ? 5 : 10) * decade;
  for (double tick = std::ceil(from / step) * step; tick <= to + 1e-9 * step; tick += step) ticks.push_back(tick);
  return ticks;
}

std::string Axis::tickText(double value) const {
  if (std::abs(value) < 1e-12) value = 0;
  if (!names.empty()) return names.at(static_cast<size_t>(value));
  return percent ? fmt::format("{:.4g}%", 100 * value) : fmt::format("{:.4g}", value);
}

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
    case '&':
      result += "&amp;";
      break;
    case '<':
      result += "&lt;";
      break;
    case '>':
      result += "&gt;";
      break;
    case '"':
      result += "&quot;";
      break;
    default:
      result += c;
    }
  }
  return result;
}

Plot::Plot(Axis x, Axis y) : x_(std::move(x)), y_(std::move(y)) {
  const double bottom = kHeight - kBottom, right = kWidth - kRight;
  for (const double tick : x_.ticks()) {
    const double at = pixelX(tick);
    body_ += fmt::format("<path class='grid' d='M{:.1f} {:.1f}V{:.1f}'/>", at, kTop, bottom);
    text(at, bottom + 16, "tick middle", x_.tickText(tick));
  }
  for (const double tick : y_.ticks()) {
    const double at = pixelY(tick);
    body_ += fmt::format("<path class='grid' d='M{:.1f} {:.1f}H{:.1f}'/>", kLeft, at, right);
    text(kLeft - 6, at + 4, "tick end", y_.tickText(tick));
  }
  text((kLeft + right) / 2, kHeight - 8, "tick middle", x_.label);
  body_ += fmt::format("<text class='tick middle' transform='translate(14 {:.1f}) rotate(-90)'>{}</text>",
                       (kTop + bottom) / 2, escaped(y_.label));
}

double Plot::pixelX(double value) const { return kLeft + x_.position(value) * (kWidth - kLeft - kRight); }
double Plot::pixelY(double value) const { return kTop + (1 - y_.position(value)) * (kHeight - kTop - kBottom); }

void Plot::text(double x, double y, const std::string& style, const std::string& content) {
  body_ += fmt::format("<text class='{}' x='{:.1f}' y='{:.1f}'>{}</text>", style, x, y, escaped(content));
}

void Plot::line(const std::vector<Point>& points, const std::string& style, const std::string& label) {
  if (points.empty()) return;
  std::string path;
  for (const Point& point : points)
    path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", pixelX(point.x), pixelY(point.y));
  body_ += fmt::format("<path class='line {}' d='{}'><title>{}</title></path>", style, path, escaped(label));
}

void Plot::mark(Point point, const std::string& style, const std::string& title, const std::string& label) {
  const double x = pixelX(point.x), y = pixelY(point.y);
  body_ += fmt::format("<circle class='mark {}' cx='{:.1f}' cy='{:.1f}' r='4'><title>{}</title></circle>", style, x, y,
                       escaped(title));
  if (!label.empty()) text(x + 7, y + 4, "tick " + style, label);
}

void Plot::whisker(Point from, Point to, const std::string& style) {
  body_ += fmt::format("<path class='whisker {}' d='M{:.1f} {:.1f}L{:.1f} {:.1f}'/>", style, pixelX(from.x),
                       pixelY(from.y), pixelX(to.x), pixelY(to.y));
}

std::string Plot::svg() const {
  return fmt::format("<svg viewBox='0 0 {} {}' role='img'>{}</svg>", kWidth, kHeight, body_);
}

std::string Plot::svgFile(const std::string& style) const {
  return fmt::format("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {0} {1}' width='{0}' "
                     "height='{1}'><style>{2}</style>{3}</svg>\n",
                     kWidth, kHeight, style, body_);
}

} // namespace isophote::cli
