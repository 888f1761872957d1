// The image comparison of support/render.hpp accepts equal expectations and sees planted errors.
#include <gtest/gtest.h>

#include "support/render.hpp"
#include "support/scenes.hpp"

namespace isophote::test {
namespace {

MeasuredImage render(uint64_t seed, uint32_t samples = 2000) {
  static const Scene kScene = boxFurnace(glm::vec3(1), glm::vec3(0.5f));
  return measured(oracle::renderReference(kScene, boxFurnaceCamera(), 16, 16, samples, {.seed = seed}));
}

constexpr AgreementRule kRule{.powerFloor = 0.01};

TEST(ImageStatistics, AcceptsTwoSeedsOfOneImage) { EXPECT_TRUE(sameImage(render(1), render(2), kRule)); }

TEST(ImageStatistics, SeesAPercentOfBias) {
  MeasuredImage biased = render(2);
  for (auto& pixel : biased.pixels) pixel[1].mean *= 1.01;
  EXPECT_FALSE(sameImage(render(1), biased, kRule));
}

TEST(ImageStatistics, SeesOneWrongBlock) {
  MeasuredImage biased = render(2);
  for (uint32_t y = 8; y < 12; ++y) {
    for (uint32_t x = 4; x < 8; ++x) biased.pixels[16 * y + x][2].mean *= 1.08;
  }
  EXPECT_FALSE(sameImage(render(1), biased, kRule));
}

TEST(ImageStatistics, SeesAFewPixelsThatAreFarOff) {
  MeasuredImage biased = render(2);
  biased.pixels[100][0].mean = 0; // one pixel-channel of 768 is more than 0.1%
  EXPECT_FALSE(sameImage(render(1), biased, kRule));
}

TEST(ImageStatistics, CallsNoisyImagesInconclusive) { EXPECT_FALSE(sameImage(render(1, 8), render(2, 8), kRule)); }

TEST(ImageStatistics, DifferencesWithoutNoiseNeedNoErrorBars) {
  MeasuredImage a{4, 4, std::vector<std::array<Estimate, 3>>(16, {Estimate{1, 0, 7}, {2, 0, 7}, {0, 0, 7}})};
  MeasuredImage b = a;
  EXPECT_TRUE(sameImage(a, b));
  for (auto& pixel : b.pixels) pixel[1].mean += 0.001;
  EXPECT_FALSE(sameImage(a, b));
  EXPECT_TRUE(sameImage(a, b, {.absoluteTolerance = 0.0011}));
}

TEST(ImageStatistics, MeanTestSeesItsPowerFloorAndAsksForEnoughSamples) {
  Moments exact, noisy;
  for (int i = 0; i < 1000; ++i) {
    exact.add(2 + 0.01 * ((i * 7919) % 1000 - 499.5) / 500);
    noisy.add(2 + ((i * 7919) % 1000 - 499.5) / 500);
  }
  EXPECT_TRUE(meanIs(exact, 2));
  EXPECT_FALSE(meanIs(exact, 2.006));
  EXPECT_FALSE(meanIs(noisy, 2)); // right, but not known well enough
}

} // namespace
} // namespace isophote::test
