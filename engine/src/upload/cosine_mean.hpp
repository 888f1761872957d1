// Means over the hemisphere of tables that the device reads linear in sqrt(mu).
#pragma once

#include <cmath>
#include <span>

#include <glm/glm.hpp>

namespace isophote {

/// The cosine-weighted mean of values at mu = (c / (count - 1))^2 taken linear in sqrt(mu): with x = sqrt(mu),
/// 2 mu dmu = 4 x^3 dx, integrated exactly over each interval. So what lobes pass on according to the mean is exactly
/// what they lose on the device.
inline glm::dvec2 cosineMean(std::span<const glm::dvec2> row) {
  glm::dvec2 sum(0);
  const auto last = static_cast<double>(row.size() - 1);
  for (size_t c = 0; c + 1 < row.size(); ++c) {
    const double x0 = static_cast<double>(c) / last;
    const double x1 = static_cast<double>(c + 1) / last;
    const glm::dvec2 slope = (row[c + 1] - row[c]) / (x1 - x0);
    const glm::dvec2 offset = row[c] - slope * x0;
    sum += offset * (std::pow(x1, 4) - std::pow(x0, 4)) + slope * 0.8 * (std::pow(x1, 5) - std::pow(x0, 5));
  }
  return sum;
}

} // namespace isophote
