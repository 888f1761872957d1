// Separable filters over one float plane.
#pragma once

#include <cstdint>
#include <vector>

namespace isophote::estimate {

struct Plane {
  uint32_t width = 0;
  uint32_t height = 0;
  std::vector<float> values;
};

/// Weights at offsets -radius to radius.
struct Kernel1d {
  std::vector<float> weights;
  [[nodiscard]] int radius() const { return static_cast<int>(weights.size() / 2); }
};

/// exp(-x^2 / (2 deviation^2)) at -radius to radius, normalized to sum 1.
[[nodiscard]] Kernel1d gaussian(double deviation, int radius);

/// -x or x^2/deviation^2 - 1 times the Gaussian; positive weights scaled to sum 1, negative ones to sum -1.
[[nodiscard]] Kernel1d gaussianFirstDerivative(double deviation, int radius);
[[nodiscard]] Kernel1d gaussianSecondDerivative(double deviation, int radius);

/// Correlates rows with `horizontal` and columns with `vertical`; the border pixels continue outwards.
[[nodiscard]] Plane filter(const Plane& plane, const Kernel1d& horizontal, const Kernel1d& vertical);

} // namespace isophote::estimate
