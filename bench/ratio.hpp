// How much faster, and how sure: ratios of times that were taken side by side.
#pragma once

#include <span>

namespace isophote::bench {

struct Ratio {
  double median = 0;
  double low = 0; ///< 95% interval of the median
  double high = 0;
};

[[nodiscard]] double median(std::span<const double> values);

/// slow[i] / fast[i] over repetitions i. Pairing removes what slows both; the interval is that of the median of the
/// log-ratios under resampling of the repetitions (percentile bootstrap, fixed seed).
[[nodiscard]] Ratio pairedRatio(std::span<const double> slow, std::span<const double> fast);

} // namespace isophote::bench
