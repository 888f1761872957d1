#include "render/image_error.hpp"

#include <cmath>

namespace isophote {
namespace {

// 95% upper limit of the rate of a Poisson law of which one event was seen.
constexpr double kRareEventFactor = 4.74;

} // namespace

ErrorEstimate imageError(const ErrorSums& sums, double confidence) {
  if (sums.pixels == 0) return {};
  const double count = 3.0 * static_cast<double>(sums.pixels);
  ErrorEstimate error{.value = std::sqrt(sums.relativeSquare / count), .confidence = confidence, .known = true};
  error.untrustedShare = static_cast<double>(sums.untrustedPixels) / static_cast<double>(sums.pixels);
  if (!(sums.relativeSquare > 0)) return error;
  const double spread = 2 * sums.termSquare / (sums.relativeSquare * sums.relativeSquare);
  const double factor = std::exp(0.5 * normalTwoSided(confidence) * std::sqrt(std::log1p(spread))); // of the root
  const double pessimistic = sums.relativeSquare + (kRareEventFactor - 1) * sums.untrusted;
  error.lower = error.value / factor;
  error.upper = std::sqrt(pessimistic / count) * factor;
  return error;
}

double normalTwoSided(double confidence) {
  // Newton's iteration on erfc(z / sqrt 2) = 1 - confidence, which is convex: from 0 it rises to the root.
  const double tail = 1 - confidence;
  double z = 0;
  for (int i = 0; i < 100; ++i) {
    const double step = (std::erfc(z / std::sqrt(2.0)) - tail) / (std::sqrt(2 / M_PI) * std::exp(-0.5 * z * z));
    z += step;
    if (std::abs(step) < 1e-12) break;
  }
  return z;
}

} // namespace isophote
