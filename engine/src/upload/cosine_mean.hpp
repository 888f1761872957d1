// Means over the hemisphere of tables that the device reads linear in sqrt(mu).
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace isophote {

/// The cosine-weighted mean of values at mu = (c / (count - 1))^2 taken linear in sqrt(mu): with x = sqrt(mu),
/// 2 mu dmu = 4 x^3 dx, integrated exactly over each interval. So what lobes pass on according to the mean is exactly
/// what they lose on the device.
template <class Value, size_t kCount> Value cosineMean(const std::array<Value, kCount>& row) {
  Value sum(0);
  const auto last = static_cast<double>(kCount - 1);
  for (size_t c = 0; c + 1 < kCount; ++c) {
    const double x0 = static_cast<double>(c) / last;
    const double x1 = static_cast<double>(c + 1) / last;
    const Value slope = (row[c + 1] - row[c]) / (x1 - x0);
    const Value offset = row[c] - slope * x0;
    sum += offset * (std::pow(x1, 4) - std::pow(x0, 4)) + slope * 0.8 * (std::pow(x1, 5) - std::pow(x0, 5));
  }
  return sum;
}

} // namespace isophote
