#include "render/pixel_error.hpp"

#include <algorithm>
#include <cmath>

namespace isophote {
namespace {

// 97.5% quantile of Student's t with 1 to 7 degrees of freedom.
constexpr std::array<double, 8> kStudent975 = {0, 12.7062, 4.30265, 3.18245, 2.77645, 2.57058, 2.44691, 2.36462};

// One event in eight replicates gives a mean of 1/8 and a standard error of 1/8 of its value. Rates up to 5.57 events
// are plausible then (the 97.5% limit of a Poisson law of which one event was seen): 4.57 standard errors above.
constexpr double kRareEventQuantile = 4.57;

// How much farther the upper end of the interval lies than Student's, for replicate means of skewness g: to first order
// by g / (6 sqrt n) (1 + 2 t^2) standard errors (Hall 1992, "The Bootstrap and Edgeworth Expansion", section 2.4: the
// quantiles of a studentized mean). Means that are skewed to the right are most often too small, and their error too.
double skewedQuantile(double student, double skewness, double replicates) {
  return student + std::max(skewness, 0.0) / (6 * std::sqrt(replicates)) * (1 + 2 * student * student);
}

} // namespace

PixelError pixelError(const std::array<int64_t, gpu::kReplicateCount>& sums,
                      const std::array<uint32_t, gpu::kReplicateCount>& counts, double valuePerUnit) {
  double total = 0;
  double count = 0;
  uint32_t replicates = 0;
  for (uint32_t r = 0; r < gpu::kReplicateCount; ++r) {
    total += static_cast<double>(sums[r]);
    count += counts[r];
    if (counts[r] > 0) ++replicates;
  }
  if (count == 0) return {.mean = 0, .standardError = 0, .halfWidth95 = 0};
  PixelError result{.mean = total / count * valuePerUnit};
  if (replicates < 2) return result;
  double squares = 0;
  double variance = 0;
  double cubes = 0;
  double largest = 0;
  for (uint32_t r = 0; r < gpu::kReplicateCount; ++r) {
    if (counts[r] == 0) continue;
    const double share = counts[r] / count;
    const double deviation = share * (static_cast<double>(sums[r]) / counts[r] * valuePerUnit - result.mean);
    squares += share * share;
    variance += deviation * deviation;
    cubes += deviation * deviation * deviation;
    largest = std::max(largest, deviation * deviation);
  }
  result.largestShare = variance > 0 ? largest / variance : 0;
  result.standardError = std::sqrt(variance / (1 - squares));
  // Of equally filled replicates, and without the bias of so few (Joanes and Gill 1998, G1).
  const double n = replicates;
  const double skewness =
      variance > 0 && replicates > 2 ? n * std::sqrt(n - 1) / (n - 2) * cubes / std::pow(variance, 1.5) : 0;
  const double quantile = skewedQuantile(kStudent975[replicates - 1], skewness, n);
  const bool rare = replicates == gpu::kReplicateCount && result.largestShare > gpu::kTrustedShare;
  result.halfWidth95 = (rare ? std::max(quantile, kRareEventQuantile) : quantile) * result.standardError;
  return result;
}

double trust(double largestShare) {
  constexpr double kEven = 1.0 / gpu::kReplicateCount;
  constexpr double kAlone = 1 - kEven; // the deviations add up to 0: the others hold an eighth between them
  return std::clamp((kAlone - largestShare) / (kAlone - kEven), 0.0, 1.0);
}

} // namespace isophote
