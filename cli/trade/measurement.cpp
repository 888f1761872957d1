#include "trade/measurement.hpp"

#include <algorithm>
#include <cmath>

namespace isophote::cli {

Interval Measurement::seconds() const {
  std::vector<double> seconds;
  for (const Run& run : runs) seconds.push_back(run.seconds);
  return meanInterval(seconds);
}

Price priceOf(const Measurement& measurement, const Measurement& base) {
  std::vector<double> seconds, baseSeconds, noise, baseNoise, cost, baseCost;
  for (const Run& run : measurement.runs) {
    for (const Run& other : base.runs) {
      if (other.round != run.round) continue;
      const double share = double(run.samples) / other.samples;
      seconds.push_back(run.seconds / share);
      baseSeconds.push_back(other.seconds);
      noise.push_back(run.noiseSquare * share);
      baseNoise.push_back(other.noiseSquare);
      cost.push_back(run.seconds * run.noiseSquare);
      baseCost.push_back(other.seconds * other.noiseSquare);
    }
  }
  return {.seconds = ratioInterval(seconds, baseSeconds),
          .noise = ratioInterval(noise, baseNoise),
          .cost = ratioInterval(cost, baseCost)};
}

TradeOff tradeOffOf(const Measurement& measurement, const Measurement& base) {
  return {.cost = base.seconds().value * base.split.noiseSquare.value * priceOf(measurement, base).cost.value,
          .biasSquare = measurement.declaredUnbiased ? 0 : std::max(0.0, measurement.split.biasSquare.upper)};
}

bool biasIsSeen(const ErrorSplit& split, size_t tests, bool pixels) {
  if (split.runs < 2) return false;
  // Two tests each, of the squared bias (one tail) and of the brightness; Bonferroni.
  const double level = 0.01 / (2 * static_cast<double>(std::max<size_t>(tests, 1)));
  const auto tail = [](double deviations) { return 0.5 * std::erfc(deviations / std::sqrt(2.0)); };
  return (pixels && tail(split.biasDeviations) < level) || 2 * tail(std::abs(split.brightnessDeviations)) < level;
}

} // namespace isophote::cli
