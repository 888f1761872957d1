#include "estimate/flip_filter.hpp"

#include <algorithm>
#include <cmath>

namespace isophote::estimate {
namespace {

double gaussianAt(int x, double deviation) { return std::exp(-0.5 * x * x / (deviation * deviation)); }

Kernel1d normalized(const std::vector<double>& weights) {
  double positive = 0;
  double negative = 0;
  for (const double w : weights) (w > 0 ? positive : negative) += std::abs(w);
  Kernel1d kernel;
  for (const double w : weights)
    kernel.weights.push_back(static_cast<float>(w > 0 ? w / positive : w < 0 ? w / negative : 0));
  return kernel;
}

template <class Weight> Kernel1d makeKernel(int radius, Weight weight) {
  std::vector<double> weights;
  for (int x = -radius; x <= radius; ++x) weights.push_back(weight(x));
  return normalized(weights);
}

Plane filterRows(const Plane& plane, const Kernel1d& kernel) {
  Plane result{plane.width, plane.height, std::vector<float>(plane.values.size())};
  const int radius = kernel.radius();
  const size_t width = plane.width;
  std::vector<float> padded(width + 2 * static_cast<size_t>(radius));
  for (size_t y = 0; y < plane.height; ++y) {
    const float* row = plane.values.data() + y * width;
    std::fill_n(padded.begin(), radius, row[0]);
    std::copy_n(row, width, padded.begin() + radius);
    std::fill_n(padded.begin() + radius + static_cast<std::ptrdiff_t>(width), radius, row[width - 1]);
    float* out = result.values.data() + y * width;
    for (size_t k = 0; k < kernel.weights.size(); ++k) {
      const float weight = kernel.weights[k];
      for (size_t x = 0; x < width; ++x) out[x] += weight * padded[x + k];
    }
  }
  return result;
}

Plane filterColumns(const Plane& plane, const Kernel1d& kernel) {
  Plane result{plane.width, plane.height, std::vector<float>(plane.values.size())};
  const size_t width = plane.width;
  const int64_t last = int64_t(plane.height) - 1;
  for (int64_t y = 0; y <= last; ++y) {
    float* out = result.values.data() + static_cast<size_t>(y) * width;
    for (size_t k = 0; k < kernel.weights.size(); ++k) {
      const int64_t source = std::clamp<int64_t>(y + static_cast<int64_t>(k) - kernel.radius(), 0, last);
      const float* in = plane.values.data() + static_cast<size_t>(source) * width;
      const float weight = kernel.weights[k];
      for (size_t x = 0; x < width; ++x) out[x] += weight * in[x];
    }
  }
  return result;
}

} // namespace

Kernel1d gaussian(double deviation, int radius) {
  return makeKernel(radius, [=](int x) { return gaussianAt(x, deviation); });
}

Kernel1d gaussianFirstDerivative(double deviation, int radius) {
  return makeKernel(radius, [=](int x) { return -x * gaussianAt(x, deviation); });
}

Kernel1d gaussianSecondDerivative(double deviation, int radius) {
  return makeKernel(radius, [=](int x) { return (x * x / (deviation * deviation) - 1) * gaussianAt(x, deviation); });
}

Plane filter(const Plane& plane, const Kernel1d& horizontal, const Kernel1d& vertical) {
  return filterColumns(filterRows(plane, horizontal), vertical);
}

} // namespace isophote::estimate
