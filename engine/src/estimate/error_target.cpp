#include "isophote/error_target.hpp"

#include <algorithm>
#include <cmath>

#include "estimate/compare_student.hpp"
#include "shared/film_types.h"

namespace isophote {
namespace {

constexpr double kLookGrowth = 0.25;
constexpr double kNormal95 = 1.959964;

// How far the exponent of error^2 over samples, 1 in expectation, was seen to differ: measured, see docs/accuracy.md.
constexpr double kExponentSpread = 0.2;

/// Standard deviation of the estimate's logarithm, from its log-normal interval.
double logDeviation(const ErrorEstimate& error) {
  if (!(error.lower > 0)) return 0;
  return std::log(error.value / error.lower) / estimate::normalDeviation(1 - error.confidence);
}

/// Half-width of the 95% interval of the logarithm of the squared error at `growth` times the samples, over what
/// samples^-1 says.
double logHalfWidth(const ErrorEstimate& error, double growth) {
  const double scatter = 2 * logDeviation(error) * std::sqrt(2 * (1 - 1 / growth));
  return kNormal95 * scatter + kExponentSpread * std::log(growth);
}

} // namespace

uint64_t nextLook(uint64_t samples) {
  const auto rounds = static_cast<uint64_t>(kLookGrowth * static_cast<double>(samples)) / gpu::kReplicateCount;
  return samples + std::max<uint64_t>(rounds, 1) * gpu::kReplicateCount;
}

bool reached(const ErrorTarget& target, const ErrorEstimate& error) {
  return error.known && error.upper <= target.error;
}

Interval forecastSamples(const ErrorLook& look, const ErrorTarget& target) {
  const double missing = look.error.upper / target.error;
  if (!(missing > 1)) return {look.samples, look.samples, look.samples};
  const double growth = missing * missing;
  const double half = logHalfWidth(look.error, growth);
  return {.value = look.samples * growth,
          .lower = look.samples * std::max(growth * std::exp(-half), 1.0),
          .upper = look.samples * growth * std::exp(half) * (1 + kLookGrowth)};
}

Interval forecastError(const ErrorLook& look, double samples) {
  const double growth = samples / look.samples;
  const double value = look.error.value / std::sqrt(growth);
  // Of the samples that both hold, the estimate's own interval remains.
  const double common = std::min(growth, 1 / growth);
  const double known = kNormal95 * logDeviation(look.error) * std::sqrt(common);
  const double half = 0.5 * logHalfWidth(look.error, 1 / common) + known;
  return {.value = value, .lower = value * std::exp(-half), .upper = value * std::exp(half)};
}

double upperOfLargerImage(const ErrorEstimate& error, double pixelRatio) {
  if (!(error.lower > 0)) return error.upper;
  // image_error.hpp: the logarithm's variance is log1p(spread) / 4, and the spread falls with the number of pixels.
  const double z = estimate::normalDeviation(1 - error.confidence);
  const double deviation = 2 * logDeviation(error);
  const double spread = std::expm1(deviation * deviation) / pixelRatio;
  const double factor = std::exp(0.5 * z * std::sqrt(std::log1p(spread)));
  const double before = error.value / error.lower;
  return error.upper / before * factor;
}

} // namespace isophote
