// Which pixels get more samples.
#include <numeric>

#include <gtest/gtest.h>

#include "isophote/sample_allocation.hpp"

namespace isophote {
namespace {

/// 16 x 8 pixels of radiance 1 whose left half has `left` of standard error, the right one `right`.
Image halves(float left, float right) {
  Image image{.width = 16, .height = 8};
  for (const char* name : {"R", "G", "B"}) image.channels.push_back({name, std::vector<float>(128, 1)});
  for (const char* name : {"stderr.R", "stderr.G", "stderr.B"}) {
    image.channels.push_back({name, std::vector<float>(128)});
    for (uint32_t i = 0; i < 128; ++i) image.channels.back().values[i] = i % 16 < 8 ? left : right;
  }
  return image;
}

size_t pixelCount(const SampleAllocation& allocation) {
  size_t count = 0;
  for (const auto& pixels : allocation.pixels) count += pixels.size();
  return count;
}

TEST(SampleAllocation, EvenErrorsGetEvenShares) {
  const SampleAllocation allocation = allocateSamples(halves(0.1f, 0.1f));
  EXPECT_EQ(pixelCount(allocation), 128u);
  EXPECT_NEAR(allocation.expectedGain, 1, 1e-9);
  const SampleAllocation black = allocateSamples(halves(0, 0));
  EXPECT_EQ(pixelCount(black), 128u);
  EXPECT_EQ(black.expectedGain, 1);
}

// Deviations of 1 to 9: shares of 1/3 (the least) and 9/5 of the mean, six times as much, rounded to 4 or 8. The best
// gain is (1 + 81) / 2 over the squared mean deviation, 25: 1.64.
TEST(SampleAllocation, NoisyHalvesGetMoreAndGainNearlyWhatIsPossible) {
  const SampleAllocation allocation = allocateSamples(halves(0.01f, 0.09f));
  EXPECT_EQ(pixelCount(allocation), 128u);
  EXPECT_GT(allocation.expectedGain, 1.35);
  EXPECT_LT(allocation.expectedGain, 1.64);
  for (const uint32_t pixel : allocation.pixels[0]) EXPECT_LT(pixel % 16, 8u);
  for (const uint32_t pixel : allocation.pixels[3]) EXPECT_GE(pixel % 16, 8u);
}

} // namespace
} // namespace isophote
