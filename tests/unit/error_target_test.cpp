// Forecasts of the samples to a target error, on error curves with known laws.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "isophote/error_target.hpp"

namespace isophote {
namespace {

/// An estimate whose logarithm has this standard deviation: what the image's estimate says of itself.
ErrorEstimate estimateOf(double value, double deviation) {
  const double factor = std::exp(1.959964 * deviation);
  return {.value = value, .lower = value / factor, .upper = value * factor, .known = true};
}

TEST(ErrorTarget, LooksComeAfterEachQuarterInWholeRounds) {
  EXPECT_EQ(nextLook(0), 8u);
  EXPECT_EQ(nextLook(8), 16u);
  EXPECT_EQ(nextLook(64), 80u);
  EXPECT_EQ(nextLook(1000), 1248u);
  EXPECT_EQ(nextLook(4'000'000'000), 5'000'000'000u); // beyond 32 bits: callers limit it
}

TEST(ErrorTarget, IsReachedByTheUpperEndOfAKnownError) {
  const ErrorTarget target{.error = 0.02};
  EXPECT_TRUE(reached(target, {.value = 0.015, .lower = 0.01, .upper = 0.02, .known = true}));
  EXPECT_FALSE(reached(target, {.value = 0.015, .lower = 0.01, .upper = 0.0201, .known = true}));
  EXPECT_FALSE(reached(target, {}));
}

TEST(ErrorTarget, HalfTheErrorTakesFourTimesTheSamples) {
  const Interval samples = forecastSamples({100, estimateOf(0.04, 0)}, {.error = 0.02});
  EXPECT_NEAR(samples.value, 400, 1e-9);
  EXPECT_LT(samples.lower, 400);
  EXPECT_GT(samples.upper, 500); // the next look
  const Interval error = forecastError({100, estimateOf(0.04, 0)}, 400);
  EXPECT_NEAR(error.value, 0.02, 1e-12);
  EXPECT_TRUE(error.holds(0.018));
  EXPECT_NEAR(forecastError({100, estimateOf(0.04, 0)}, 25).value, 0.08, 1e-12);
}

TEST(ErrorTarget, AReachedTargetNeedsNoMore) {
  const Interval samples = forecastSamples({96, estimateOf(0.01, 0.01)}, {.error = 0.02});
  EXPECT_EQ(samples.value, 96);
  EXPECT_EQ(samples.upper, 96);
}

TEST(ErrorTarget, ALargerImageHasANarrowerInterval) {
  const ErrorEstimate pilot = estimateOf(0.1, 0.1);
  EXPECT_NEAR(upperOfLargerImage(pilot, 1), pilot.upper, 1e-9);
  EXPECT_NEAR(std::log(upperOfLargerImage(pilot, 100) / 0.1), 0.1 * std::log(pilot.upper / 0.1), 5e-4);
}

// Error curves error(n) = c n^-b whose estimates scatter log-normally, those of later samples less and less like those
// of now: 4000 curves stop where the rule stops, and the forecast made at 64 samples is held against that.
double forecastCoverage(double exponent, double deviation, double drift = 0) {
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal;
  int held = 0;
  constexpr int kCurves = 4000;
  for (int curve = 0; curve < kCurves; ++curve) {
    double walk = 0; // sum over the samples so far of independent unit noise
    double before = 0;
    const auto estimate = [&](uint64_t samples) {
      const auto n = static_cast<double>(samples);
      walk += std::sqrt(n - before) * normal(random);
      before = n;
      const double value = std::exp(-exponent * std::log(n) + deviation * walk / std::sqrt(n));
      return estimateOf(value, deviation);
    };
    const ErrorTarget target{.error = std::pow(1500.0, -exponent)};
    uint64_t n = 64;
    const Interval forecast = forecastSamples({64, estimate(n)}, {.error = target.error * std::exp(-drift)});
    while (!reached(target, estimate(n = nextLook(n)))) {
    }
    held += forecast.holds(static_cast<double>(n)) ? 1 : 0;
  }
  return double(held) / kCurves;
}

TEST(ErrorTarget, TheForecastsIntervalHoldsTheSamplesThatWereNeeded) {
  EXPECT_GT(forecastCoverage(0.5, 0.02), 0.95);
  EXPECT_GT(forecastCoverage(0.5, 0.15), 0.95);
  EXPECT_GT(forecastCoverage(0.58, 0.05), 0.95);    // Sobol points
  EXPECT_LT(forecastCoverage(0.5, 0.05, 0.8), 0.5); // a forecast that is wrong by a factor of 5 is seen
}

} // namespace
} // namespace isophote
