// How a render is getting on, on stderr.
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>

#include "isophote/film.hpp"
#include "isophote/interval.hpp"

namespace isophote::cli {

struct RenderState {
  double fraction = 0; ///< of the work; floored when shown, so 100% means done
  double seconds = 0;
  double rays = 0;
  ErrorEstimate error;
  std::optional<Interval> ends; ///< seconds at the end, where a forecast says more than the fraction
};

/// `0:12`, `1:02:03`
[[nodiscard]] std::string clockText(double seconds);

/// `37%  0:12 elapsed, 0:20 left, 4.31 Mrays/s, error 2.4%`; of a forecast with its interval `0:20 left (0:12 to 0:41)`
[[nodiscard]] std::string progressText(const RenderState& state);

/// On a terminal one line that is written over about ten times a second, elsewhere a line every few seconds.
class ProgressLine {
public:
  explicit ProgressLine(bool quiet);
  ~ProgressLine() { clear(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// Whether it is time for another line; asking costs nothing.
  [[nodiscard]] bool due() const;
  void show(const RenderState& state) { show(progressText(state)); }
  void show(const std::string& text);
  /// Takes the line off a terminal, before other output.
  void clear();

private:
  using Clock = std::chrono::steady_clock;
  bool quiet_;
  bool terminal_;
  Clock::time_point last_ = Clock::now();
  size_t shown_ = 0; ///< characters now on the terminal's line
};

} // namespace isophote::cli
