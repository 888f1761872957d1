// How fast a render goes, with an interval.
#pragma once

#include <vector>

#include "isophote/interval.hpp"

namespace isophote::cli {

/// Seconds a sample (of every pixel), from passes over the samples.
class Pace {
public:
  void add(double samples, double seconds);
  /// Nothing to go by yet.
  [[nodiscard]] bool known() const { return samples_ > 0; }
  /// The value is that of the later half of the samples: a render's first passes are too short to fill the device. The
  /// 95% interval is from the spread of the passes among them; a pace known from one pass may be off by a half.
  [[nodiscard]] Interval secondsPerSample() const;

private:
  struct Pass {
    double samples = 0;
    double seconds = 0;
  };
  std::vector<Pass> passes_;
  double samples_ = 0;
};

/// The product of two positive estimates that err independently, by factors.
[[nodiscard]] Interval product(const Interval& a, const Interval& b);

} // namespace isophote::cli
