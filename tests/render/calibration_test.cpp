// Error bars of a render whose answer is known: 95% intervals hold it for 93% to 97% of the values, and a fault of the
// size that matters is seen.
#include <cmath>

#include <gtest/gtest.h>

#include "isophote/coverage.hpp"
#include "support/render.hpp"
#include "support/scenes.hpp"

namespace isophote {
namespace {

using namespace isophote::test;

constexpr uint32_t kSide = 16;

/// A Lambertian plane of reflectance 0.5 that fills the view, under a sky of `radiance`: half of that everywhere. With
/// lights sampled alone there is noise: directions are uniform over the sphere.
Image plainUnderSky(float radiance) {
  Scene scene;
  scene.environment = constantEnvironment(glm::vec3(radiance));
  addPrimitive(scene, quad({-50, 0, 50}, {100, 0, 0}, {0, 0, -100}, addMaterial(scene, lambert(glm::vec3(0.5f)))));
  RenderOptions options;
  options.estimator.lightSampling = LightSampling::LightsOnly;
  return renderImage(scene, lookAt({0, 2, 0}, {0, 0, -0.5}, 0.6), kSide, kSide, 512, options);
}

/// The channels of a pixel deviate alike under a white sky: there are as many independent values as pixels.
Coverage coverageOf(const Image& image) {
  Image truth{.width = kSide, .height = kSide};
  for (const char* name : {"R", "G", "B"}) truth.channels.push_back({name, std::vector<float>(kSide * kSide, 0.5f)});
  Coverage coverage;
  addCoverage(image, truth, coverage);
  return coverage;
}

// 256 independent pixels: the share's standard deviation is 1.4%, so that the seed is one of those that pass; a fault
// must be seen beyond doubt.
TEST(Calibration, IntervalsOfAKnownAnswerHoldIt) {
  const Coverage coverage = coverageOf(plainUnderSky(1));
  EXPECT_TRUE(coverage.calibrated()) << coverage.coveredShare();
  EXPECT_EQ(coverage.missedBlind, 0u);
}

TEST(Calibration, ABiasOfOnePercentIsCaught) {
  const Coverage coverage = coverageOf(plainUnderSky(1.01f));
  EXPECT_FALSE(coverage.calibrated()) << coverage.coveredShare();
  EXPECT_LT(coverage.coveredShare(), 0.88);
}

TEST(Calibration, AHalvedVarianceIsCaught) {
  Image image = plainUnderSky(1);
  for (Channel& channel : image.channels) {
    if (!channel.name.starts_with("ci95")) continue;
    for (float& value : channel.values) value *= std::sqrt(0.5f);
  }
  EXPECT_FALSE(coverageOf(image).calibrated()) << coverageOf(image).coveredShare();
}

} // namespace
} // namespace isophote
