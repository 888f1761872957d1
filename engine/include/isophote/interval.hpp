// Estimates with their confidence intervals.
#pragma once

#include <span>

namespace isophote {

struct Interval {
  double value = 0;
  double lower = 0;
  double upper = 0;
  [[nodiscard]] bool holds(double truth) const { return lower <= truth && truth <= upper; }
};

/// Student's interval of the expectation of `values`, which are independent. Infinite where there are fewer than two.
/// @param confidence  two-sided, in (0, 1)
[[nodiscard]] Interval meanInterval(std::span<const double> values, double confidence = 0.95);

/// The ratio of what was measured in pairs, one after the other, so that what disturbs both alike cancels: the
/// geometric mean of a[i] / b[i] with Student's interval of the logarithms.
/// @param a, b  positive, of one length
[[nodiscard]] Interval ratioInterval(std::span<const double> a, std::span<const double> b, double confidence = 0.95);

} // namespace isophote
