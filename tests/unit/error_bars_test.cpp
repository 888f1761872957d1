// Error bars of pixels and images on replicates drawn from known laws.
#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>

#include "render/image_error.hpp"
#include "render/pixel_error.hpp"

namespace isophote {
namespace {

using Random = std::mt19937_64;
constexpr double kUnit = 0x1p-30;

PixelError drawPixel(Random& random, const std::function<double(Random&)>& replicateMean) {
  std::array<int64_t, gpu::kReplicateCount> sums{};
  std::array<uint32_t, gpu::kReplicateCount> counts{};
  for (uint32_t r = 0; r < gpu::kReplicateCount; ++r) {
    counts[r] = 4;
    sums[r] = static_cast<int64_t>(std::round(4 * replicateMean(random) / kUnit));
  }
  return pixelError(sums, counts, kUnit);
}

/// Share of 20000 pixels with gamma distributed replicate means, whose skewness is 2 / sqrt(shape), that holds the
/// truth.
double skewedCoverage(double shape) {
  Random random(4);
  std::gamma_distribution<double> gamma(shape, 1 / shape);
  int covered = 0;
  for (int i = 0; i < 20000; ++i) {
    const PixelError pixel = drawPixel(random, [&](Random& r) { return gamma(r); });
    covered += std::abs(pixel.mean - 1) <= pixel.halfWidth95 ? 1 : 0;
  }
  return covered / 20000.0;
}

/// Share of 20000 pixels, normal around 1 with a standard error of 0.25%, whose interval scaled by `widthFactor` holds
/// `truth`. Its standard deviation is 0.15%.
double coverage(double truth, double widthFactor) {
  Random random(1);
  std::normal_distribution<double> normal(1, 0.0025 * std::sqrt(8.0));
  int covered = 0;
  for (int i = 0; i < 20000; ++i) {
    const PixelError pixel = drawPixel(random, [&](Random& r) { return normal(r); });
    covered += std::abs(pixel.mean - truth) <= widthFactor * pixel.halfWidth95 ? 1 : 0;
  }
  return covered / 20000.0;
}

bool calibrated(double share) { return share >= 0.93 && share <= 0.97; }

TEST(ErrorBars, IntervalsOfNormalPixelsCoverTheTruthInNineteenOfTwenty) { EXPECT_TRUE(calibrated(coverage(1, 1))); }
TEST(ErrorBars, IntervalsOfSkewedPixelsCoverTheTruthToo) {
  EXPECT_TRUE(calibrated(skewedCoverage(8)));
  EXPECT_TRUE(calibrated(skewedCoverage(2))); // Student's interval alone holds 92%
}

TEST(ErrorBars, ABiasOfOnePercentIsCaught) { EXPECT_FALSE(calibrated(coverage(1.01, 1))); }
TEST(ErrorBars, AHalvedVarianceIsCaught) { EXPECT_FALSE(calibrated(coverage(1, std::sqrt(0.5)))); }

TEST(ErrorBars, TrustIsLostWhereOneReplicateMakesTheVariance) {
  const std::array<uint32_t, 8> counts = {4, 4, 4, 4, 4, 4, 4, 4};
  const PixelError once = pixelError({1 << 30, 0, 0, 0, 0, 0, 0, 0}, counts, kUnit);
  EXPECT_DOUBLE_EQ(once.largestShare, 0.875);
  EXPECT_DOUBLE_EQ(trust(once.largestShare), 0);
  EXPECT_NEAR(once.halfWidth95, 4.57 * once.mean, 1e-12); // standard error and mean are alike for one event
  const PixelError even = pixelError({1, -1, 1, -1, 1, -1, 1, -1}, counts, 1);
  EXPECT_DOUBLE_EQ(trust(even.largestShare), 1);

  // Grubbs' test at this limit misjudges 0.16% of normal pixels; 20000 of them give it with a deviation of 0.03%.
  Random random(2);
  std::normal_distribution<double> normal(1, 0.1);
  int untrusted = 0;
  for (int i = 0; i < 20000; ++i) {
    const PixelError pixel = drawPixel(random, [&](Random& r) { return normal(r); });
    untrusted += pixel.largestShare > gpu::kTrustedShare ? 1 : 0;
  }
  EXPECT_NEAR(untrusted / 20000.0, 0.0016, 0.0012);
}

TEST(ErrorBars, ReplicatesOfUnequalLengthStayUnbiasedInTheMean) {
  // 10 samples over 8 replicates: two hold two.
  const PixelError pixel = pixelError({2, 2, 1, 1, 1, 1, 1, 1}, {2, 2, 1, 1, 1, 1, 1, 1}, 1);
  EXPECT_DOUBLE_EQ(pixel.mean, 1);
  EXPECT_DOUBLE_EQ(pixel.standardError, 0);
  EXPECT_TRUE(std::isinf(pixelError({5, 0, 0, 0, 0, 0, 0, 0}, {5, 0, 0, 0, 0, 0, 0, 0}, 1).standardError));
}

/// Of 2000 images of 100 pixels of one channel, how many have a true error above the upper bound; variances spread over
/// a factor of 100. `scale` is what the estimate is multiplied with: a fault, where not 1.
double exceeding(const std::function<double(Random&)>& standardized, double scale) {
  Random random(3);
  int above = 0;
  for (int image = 0; image < 2000; ++image) {
    ErrorSums sums;
    double truth = 0;
    for (int i = 0; i < 100; ++i) {
      const double deviation = std::exp2(-3.3 * (i % 10) / 9.0);
      const PixelError pixel = drawPixel(random, [&](Random& r) { return deviation * standardized(r); });
      const double term = 3 * scale * pixel.standardError * pixel.standardError; // three channels alike
      sums.relativeSquare += term;
      sums.termSquare += term * term;
      if (pixel.largestShare > gpu::kTrustedShare) sums.untrusted += term;
      ++sums.pixels;
      truth += pixel.mean * pixel.mean / 100;
    }
    above += std::sqrt(truth) > imageError(sums, 0.95).upper ? 1 : 0;
  }
  return above / 2000.0;
}

double lognormal(Random& random) { return std::exp(2 * std::normal_distribution<double>()(random)) - std::exp(2.0); }

TEST(ErrorBars, TheImagesErrorExceedsItsUpperBoundInFewImages) {
  std::normal_distribution<double> normal;
  // One-sided 2.5%; its deviation over 2000 images is 0.35%.
  EXPECT_LE(exceeding([&](Random& r) { return normal(r); }, 1), 0.035);
  // Replicate means of skewness 414 (a lognormal of sigma 2): the target of 8% holds here too.
  EXPECT_LE(exceeding(lognormal, 1), 0.08);
}

TEST(ErrorBars, AHalvedVarianceOfTheImageIsCaught) {
  std::normal_distribution<double> normal;
  EXPECT_GT(exceeding([&](Random& r) { return normal(r); }, 0.5), 0.08);
}

TEST(ErrorBars, NormalQuantiles) {
  EXPECT_NEAR(normalTwoSided(0.95), 1.959963985, 1e-9);
  EXPECT_NEAR(normalTwoSided(0.5), 0.67448975, 1e-8);
  EXPECT_NEAR(normalTwoSided(0.9999), 3.890591886, 1e-8);
}

} // namespace
} // namespace isophote
