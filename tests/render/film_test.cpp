// What reaches the film: sums without drift, sample counts, first-hit layers.
#include <cmath>

#include <gtest/gtest.h>

#include "support/render.hpp"
#include "support/scenes.hpp"

namespace isophote {
namespace {

using namespace isophote::test;

TEST(RenderFilm, Test51ConstantsStayConstantOverMillionsOfSamples) {
  // fp32 sums of 0.1 are off by 1.5% after 2e6 additions. One pixel, 2^22 samples through the real accumulation.
  Scene scene;
  scene.environment = constantEnvironment({0.5f, 0.1f, 3e-4f});
  const Image image = renderImage(scene, lookAt({}, {0, 0, -1}, 0.8), 1, 1, 1u << 22);
  EXPECT_NEAR(plane(image, "R")[0], 0.5, 0.5e-6);
  EXPECT_NEAR(plane(image, "G")[0], 0.1, 0.1e-6);
  EXPECT_NEAR(plane(image, "B")[0], 3e-4, 3e-10 + 1e-6 * 3e-4);
  EXPECT_EQ(plane(image, "sampleCount.Y")[0], float(1u << 22));
}

TEST(RenderFilm, Test55ScalingLightsByAPowerOfTwoScalesTheImageExactly) {
  const Image one = renderImage(cornellBox(), cornellCamera(), 12, 12, 16);
  for (const float scale : {0x1p-40f, 0x1p-3f, 0x1p20f, 0x1p60f}) {
    Scene scene = cornellBox();
    for (Material& material : scene.materials) material.emissive *= scale;
    const Image scaled = renderImage(scene, cornellCamera(), 12, 12, 16);
    for (const char* channel : {"R", "G", "B", "stderr.R"}) {
      const auto expected = plane(one, channel), actual = plane(scaled, channel);
      for (size_t i = 0; i < expected.size(); ++i)
        ASSERT_NEAR(actual[i] / scale, expected[i], 1e-6 * expected[i] + 1e-12) << channel << " times " << scale;
    }
  }
}

TEST(RenderFilm, EveryPixelHasEverySample) {
  for (const auto& [width, height] : {std::pair{1u, 1u}, {1u, 37u}, {53u, 1u}, {9u, 65u}}) {
    const Image image = renderImage(cornellBox(), cornellCamera(), width, height, 5);
    for (const float count : plane(image, "sampleCount.Y")) ASSERT_EQ(count, 5);
  }
}

TEST(RenderFilm, FirstHitLayersDescribeTheQuad) {
  Scene scene;
  addPrimitive(scene, quad({-2, -2, -3}, {4, 0, 0}, {0, 4, 0}, addMaterial(scene, lambert({0.2f, 0.4f, 0.6f}))));
  const Image image = renderImage(scene, orthographicLookAt({0, 0, 1}, {}, 1, 0.5), 8, 4, 16);
  const auto expectPlane = [&](const char* name, double expected) {
    for (const float value : plane(image, name)) ASSERT_NEAR(value, expected, 1e-5) << name;
  };
  expectPlane("albedo.R", 0.2);
  expectPlane("albedo.G", 0.4);
  expectPlane("albedo.B", 0.6);
  expectPlane("normal.X", 0);
  expectPlane("normal.Y", 0);
  expectPlane("normal.Z", 1);
  expectPlane("depth.Z", 4);
  expectPlane("position.Z", -3);
  expectPlane("A", 1);
  const auto x = plane(image, "position.X"), y = plane(image, "position.Y");
  // Row 0 is the top, column 0 the left; 16 samples scatter the mean by up to a twelfth of a pixel or so.
  for (uint32_t i = 0; i < 32; ++i) {
    EXPECT_NEAR(x[i], -1 + 0.25 * (i % 8 + 0.5), 0.09);
    EXPECT_NEAR(y[i], 0.5 - 0.25 * (i / 8 + 0.5), 0.09);
  }
}

TEST(RenderFilm, GeometryOutsideTheClippingRangeIsNotSeenByTheCamera) {
  Scene scene;
  addPrimitive(scene, facingQuad(2, 2, addMaterial(scene, emitter({1, 0, 0}))));
  addPrimitive(scene, quad({-2, -2, -1}, {4, 0, 0}, {0, 4, 0}, addMaterial(scene, emitter({0, 1, 0}))));
  Camera camera = lookAt({0, 0, 1}, {}, 0.8);
  const auto seen = [&](double znear, double zfar) {
    camera.znear = znear;
    camera.zfar = zfar;
    const Image image = renderImage(scene, camera, 4, 4, 4);
    return glm::vec2(plane(image, "R")[0], plane(image, "G")[0]);
  };
  EXPECT_EQ(seen(0.1, 0), glm::vec2(1, 0));
  EXPECT_EQ(seen(1.1, 0), glm::vec2(0, 1));
  EXPECT_EQ(seen(0.1, 0.9), glm::vec2(0, 0));
  EXPECT_EQ(seen(1.1, 1.9), glm::vec2(0, 0));
}

TEST(RenderFilm, StandardErrorsTellTheSpreadBetweenSeeds) {
  // 64 seeds. z = (mean - converged) / stderr of a pixel has 7 degrees of freedom: variance 7/5, and about 5.0% of the
  // values lie beyond the 97.5% quantile 2.365. 16 nearly independent pixel-channels of 64 seeds: the share is known to
  // 0.7%, so misjudging the error by a fifth (share 10% or 1.9%) is seen.
  const Scene scene = cornellBox();
  constexpr uint32_t kSize = 4;
  const auto reference = measured(oracle::renderReference(scene, cornellCamera(), kSize, kSize, 60000, {.seed = 4}));
  for (const auto sampler : {SamplerKind::Independent, SamplerKind::Sobol}) {
    uint32_t outside = 0, tests = 0;
    for (uint64_t seed = 0; seed < 64; ++seed) {
      const Image image = renderImage(scene, cornellCamera(), kSize, kSize, 128,
                                      {.estimator = {.sampler = sampler, .filter = PixelFilter::Box, .seed = seed}});
      const MeasuredImage result = measured(image);
      for (size_t i = 0; i < result.pixels.size(); ++i) {
        const Estimate &estimate = result.pixels[i][1], &truth = reference.pixels[i][1];
        const double z = (estimate.mean - truth.mean) / std::sqrt(estimate.variance + truth.variance);
        outside += std::abs(z) > 2.36462 ? 1 : 0;
        ++tests;
      }
    }
    EXPECT_NEAR(double(outside) / tests, 0.05, 0.03);
  }
}

} // namespace
} // namespace isophote
