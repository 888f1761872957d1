// One image on one device: whatever the shape of the work, the bits are the same.
#include <functional>
#include <tuple>

#include <gtest/gtest.h>

#include "support/gpu_device.hpp"
#include "support/render.hpp"
#include "support/scenes.hpp"

namespace isophote {
namespace {

using namespace isophote::test;

constexpr uint32_t kWidth = 23, kHeight = 17, kSamples = 24; // multiples of nothing

/// A scene with several features, so that queues of every kind are used.
Image renderStill(const RenderOptions& options) {
  return renderImage(texturedStillLife(), texturedStillLifeCamera(), kWidth, kHeight, kSamples, options);
}

TEST(RenderDeterminism, Test62TheSameRenderTwiceIsBitIdentical) {
  EXPECT_TRUE(bitIdentical(renderStill({}), renderStill({})));
}

TEST(RenderDeterminism, AnotherSeedIsAnotherImage) {
  RenderOptions other;
  other.estimator.seed = (1ull << 40) + 1; // differs in the high word only
  EXPECT_FALSE(bitIdentical(renderStill({}), renderStill(other)));
}

TEST(RenderDeterminism, Test63PoolAndWorkgroupSizesDoNotChangeABit) {
  const Image expected = renderStill({});
  for (const uint32_t pool : {64u, 1000u, 40000u}) {
    for (const uint32_t workgroup : {32u, 128u}) {
      RenderOptions options;
      options.execution = {.pathPoolSize = pool, .workgroupSize = workgroup};
      SCOPED_TRACE(testing::Message() << "pool " << pool << ", workgroup " << workgroup);
      EXPECT_TRUE(bitIdentical(renderStill(options), expected));
    }
  }
}

TEST(RenderDeterminism, Test63SubmitLengthDoesNotChangeABit) {
  const Image expected = renderStill({});
  for (const double milliseconds : {0.5, 1000.0}) {
    RenderOptions options;
    options.execution.submitMilliseconds = milliseconds;
    EXPECT_TRUE(bitIdentical(renderStill(options), expected));
  }
}

TEST(RenderDeterminism, SampleRangesMergeInAnyOrder) {
  const Image expected = renderStill({});
  const std::vector<std::vector<SampleRange>> splits{
      {{0, 8}, {8, 16}, {16, 24}}, {{16, 24}, {0, 8}, {8, 16}}, {{5, 6}, {0, 5}, {6, 24}}, {{0, 24}, {24, 24}}};
  for (const auto& ranges : splits) {
    RenderOptions options;
    options.ranges = ranges;
    EXPECT_TRUE(bitIdentical(renderStill(options), expected));
  }
}

TEST(RenderDeterminism, ACropIsThatPartOfTheFullImage) {
  const Image full = renderStill({});
  for (const PixelRect& crop : {PixelRect{3, 5, 19, 12}, PixelRect{22, 16, 23, 17}, PixelRect{0, 0, 23, 1}}) {
    RenderOptions options;
    options.crop = crop;
    const Image part = renderStill(options);
    ASSERT_EQ(part.width, crop.x1 - crop.x0);
    ASSERT_EQ(part.height, crop.y1 - crop.y0);
    ASSERT_EQ(part.channels.size(), full.channels.size());
    for (size_t c = 0; c < part.channels.size(); ++c) {
      for (uint32_t y = 0; y < part.height; ++y) {
        for (uint32_t x = 0; x < part.width; ++x) {
          ASSERT_EQ(part.channels[c].values[size_t{y} * part.width + x],
                    full.channels[c].values[size_t{y + crop.y0} * full.width + x + crop.x0])
              << part.channels[c].name << " at " << x << "," << y;
        }
      }
    }
  }
}

TEST(RenderDeterminism, ACancelledRenderLeavesAFilmOfWholeSamples) {
  // Stops after the first submit; the samples that were started are finished, and their count says how many.
  const Device& device = gpuDevice();
  const GpuScene scene(device, cornellBox());
  Film film(device, {.width = 16, .height = 16});
  PathTracer tracer(device, scene, {.filter = PixelFilter::Box}, {.pathPoolSize = 256, .submitMilliseconds = 0.1});
  EXPECT_FALSE(tracer.render(cornellCamera(), film, {0, 4096}, [](const Progress&) { return false; }));
  expectHealthy(tracer.statistics());
  const Image image = film.resolve();
  uint64_t samples = 0;
  for (const float count : plane(image, "sampleCount.Y")) samples += static_cast<uint64_t>(count);
  EXPECT_GT(samples, 0u);
  EXPECT_LT(samples, uint64_t{4096} * 256);
  EXPECT_EQ(samples, tracer.statistics().primaryRays);
}

struct FeatureScene {
  const char* name;
  std::function<std::tuple<Scene, Camera>()> make;
};

/// Base color seen directly, and as light in a furnace of unlit walls.
std::tuple<Scene, Camera> unlitBox() {
  Scene scene = boxFurnace(glm::vec3(0), glm::vec3(0.5f));
  scene.materials[0].unlit = true;
  addPrimitive(scene, box({-0.3, -0.3, -0.3}, {0.3, 0.3, 0.3}, false, addMaterial(scene, lambert(glm::vec3(0.5f)))));
  return {scene, boxFurnaceCamera()};
}

std::string featureSceneName(const testing::TestParamInfo<FeatureScene>& info) { return info.param.name; }

class FeatureScenes : public testing::TestWithParam<FeatureScene> {};

TEST_P(FeatureScenes, SpecializedKernelsGiveTheBitsOfTheFullOnes) {
  if (!gpuDevice().isCpu()) GTEST_SKIP() << "bit-identity of specialised kernels is promised for CPU devices only";
  const auto [scene, camera] = GetParam().make();
  RenderOptions full;
  full.execution.specialize = false;
  EXPECT_TRUE(bitIdentical(renderImage(scene, camera, 20, 12, 16), renderImage(scene, camera, 20, 12, 16, full)));
}

INSTANTIATE_TEST_SUITE_P(
    RenderFeatures, FeatureScenes,
    testing::Values(
        FeatureScene{"Furnace",
                     [] { return std::tuple(boxFurnace(glm::vec3(1), glm::vec3(0.5f)), boxFurnaceCamera()); }},
        FeatureScene{"Cornell", [] { return std::tuple(cornellBox(), cornellCamera()); }},
        FeatureScene{"Punctual", [] { return std::tuple(punctualStillLife(), punctualStillLifeCamera()); }},
        FeatureScene{"Spheres", [] { return std::tuple(materialSpheres(), materialSpheresCamera()); }},
        FeatureScene{"Textured", [] { return std::tuple(texturedStillLife(), texturedStillLifeCamera()); }},
        FeatureScene{"Instances", [] { return std::tuple(instanceGrid(), instanceGridCamera()); }},
        FeatureScene{"Alpha",
                     [] {
                       return std::tuple(alphaLayers(3, 0.4f), orthographicLookAt({0, 0, 3}, {}, 0.5, 0.5));
                     }},
        FeatureScene{"Unlit", unlitBox}, FeatureScene{"Nothing", [] { return std::tuple(Scene{}, Camera{}); }}),
    featureSceneName);

TEST(RenderFeatures, UnlitWallsLightADiffuseBox) {
  const auto [scene, camera] = unlitBox();
  // Walls of base color 0.5 end every path: a Lambert box of reflectance 0.5 in them shows 0.25.
  const Image image = renderImage(scene, lookAt({0, 0, 1.4}, {}, 0.2), 8, 8, 512);
  EXPECT_TRUE(pixelMeanIs(image, "R", 0.25));
}

} // namespace
} // namespace isophote
