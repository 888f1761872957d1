// Small plots as SVG, to stand within a page.
#pragma once

#include <string>
#include <vector>

namespace isophote::cli {

struct Axis {
  std::string label;
  double from = 0; ///< below `to`; positive where logarithmic
  double to = 1;
  bool logarithmic = false;
  bool percent = false;           ///< ticks are written as percentages
  std::vector<std::string> names; ///< ticks at 0, 1, 2 …, where there are any, in place of round values

  /// 0 at `from`, 1 at `to`; beyond them limited to a little outside.
  [[nodiscard]] double position(double value) const;
  /// Round values within, about six.
  [[nodiscard]] std::vector<double> ticks() const;
  [[nodiscard]] std::string tickText(double value) const;
};

/// `text` with &, <, > and quotes as HTML and XML want them.
[[nodiscard]] std::string escaped(const std::string& text);

class Plot {
public:
  Plot(Axis x, Axis y);

  struct Point {
    double x = 0;
    double y = 0;
  };
  /// @param style  a class of the page's style sheet
  void line(const std::vector<Point>& points, const std::string& style, const std::string& label = "");
  /// @param title  shown under the pointer
  void mark(Point point, const std::string& style, const std::string& title, const std::string& label = "");
  void whisker(Point from, Point to, const std::string& style);
  [[nodiscard]] std::string svg() const;
  /// A file of its own. @param style  the style sheet
  [[nodiscard]] std::string svgFile(const std::string& style) const;

private:
  [[nodiscard]] double pixelX(double value) const;
  [[nodiscard]] double pixelY(double value) const;
  void text(double x, double y, const std::string& style, const std::string& content);

  Axis x_;
  Axis y_;
  std::string body_;
};

} // namespace isophote::cli
