#include "upload/filter_table.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "shared/camera_types.h"

namespace isophote {

namespace {

constexpr double kGaussianDeviation = 0.5;
constexpr double kBlackmanHarris[4] = {0.35875, 0.48829, 0.14128, 0.01168}; // Harris 1978, table 1

/// Weight on [0, x] relative to the whole filter, 0 <= x <= radius.
double halfCdf(PixelFilter filter, double x) {
  const double radius = filterRadius(filter);
  switch (filter) {
  case PixelFilter::Box:
    return x;
  case PixelFilter::Gaussian: {
    const double scale = 1 / (kGaussianDeviation * std::numbers::sqrt2);
    return 0.5 * std::erf(x * scale) / std::erf(radius * scale);
  }
  case PixelFilter::BlackmanHarris: {
    double sum = kBlackmanHarris[0] * x;
    for (int k = 1; k < 4; ++k) {
      const double frequency = k * std::numbers::pi / radius;
      sum += kBlackmanHarris[k] * std::sin(frequency * x) / frequency;
    }
    return 0.5 * sum / (kBlackmanHarris[0] * radius);
  }
  }
  return 0;
}

} // namespace

double filterRadius(PixelFilter filter) {
  switch (filter) {
  case PixelFilter::Box:
    return 0.5;
  case PixelFilter::Gaussian:
    return 2;
  case PixelFilter::BlackmanHarris:
    return 1.5;
  }
  return 0;
}

double filterWeight(PixelFilter filter, double x) {
  const double radius = filterRadius(filter);
  if (std::abs(x) > radius) return 0;
  switch (filter) {
  case PixelFilter::Box:
    return 1;
  case PixelFilter::Gaussian:
    return std::exp(-0.5 * x * x / (kGaussianDeviation * kGaussianDeviation));
  case PixelFilter::BlackmanHarris: {
    const double angle = std::numbers::pi * x / radius; // the window is centered on 0, so every term adds
    return kBlackmanHarris[0] + kBlackmanHarris[1] * std::cos(angle) + kBlackmanHarris[2] * std::cos(2 * angle) +
           kBlackmanHarris[3] * std::cos(3 * angle);
  }
  }
  return 0;
}

double filterCdf(PixelFilter filter, double x) {
  const double radius = filterRadius(filter);
  const double half = halfCdf(filter, std::min(std::abs(x), radius));
  return x < 0 ? 0.5 - half : 0.5 + half;
}

std::vector<float> filterTable(PixelFilter filter) {
  const uint32_t last = gpu::kFilterTableSize - 1;
  const double radius = filterRadius(filter);
  std::vector<float> table(gpu::kFilterTableSize);
  for (uint32_t i = 0; i <= last / 2; ++i) {
    // The upper half by bisection; 60 halvings of at most 2 pixels reach the resolution of double.
    const double target = static_cast<double>(i) / last;
    double low = 0;
    double high = radius;
    for (int step = 0; step < 60; ++step) {
      const double middle = 0.5 * (low + high);
      (halfCdf(filter, middle) < target ? low : high) = middle;
    }
    const double x = i == 0 ? 0 : (i == last / 2 ? radius : 0.5 * (low + high));
    table[last / 2 - i] = static_cast<float>(-x);
    table[last / 2 + i] = static_cast<float>(x);
  }
  return table;
}

} // namespace isophote
