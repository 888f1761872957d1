// What reaches the film: sums without drift, sample counts, first-hit layers.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "support/gpu_device.hpp"
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

constexpr double kQuantile = 2.36462; // 97.5%, Student's law with 7 degrees of freedom

/// A scene whose pixels all have one known expectation.
struct KnownPixels {
  Scene scene;
  Camera camera;
  double expected;
};

std::vector<KnownPixels> knownPixels() {
  Scene floorUnderSky = lambertFloor(glm::vec3(0.5f), 5);
  floorUnderSky.environment = constantEnvironment(glm::vec3(1));
  return {{squareLightOverFloor(1), sensorAt({0.5, 0, 0.5}), 0.1385323412},
          {floorUnderSky, sensorAt({0, 0, 0}), 0.5},
          {boxFurnace(glm::vec3(1), glm::vec3(0.5f)), boxFurnaceCamera(), 2}};
}

struct Deviations {
  double outside = 0; ///< share of pixels further from the expectation than their error bar says
  double rms = 0;
};

Deviations deviationsOf(const KnownPixels& known, SamplerKind sampler) {
  const Image image = renderImage(known.scene, known.camera, 64, 64, 512,
                                  {.estimator = {.sampler = sampler, .filter = PixelFilter::Box, .seed = 77}});
  const auto means = plane(image, "G"), errors = plane(image, "stderr.G"), half = plane(image, "ci95.G"),
             trust = plane(image, "trust.Y");
  Deviations result;
  for (size_t i = 0; i < means.size(); ++i) {
    const double difference = std::abs(means[i] - known.expected);
    result.outside += difference > kQuantile * errors[i] ? 1.0 / 4096 : 0;
    result.rms += difference * difference / 4096;
    if (trust[i] > 0.1001f) {
      EXPECT_GE(half[i], (kQuantile - 1e-3) * errors[i]); // wider where skewed
    }
  }
  result.rms = std::sqrt(result.rms);
  return result;
}

/// Over pixels of one expectation, z = (mean - expected) / stderr follows Student's law with 7 degrees of freedom where
/// replicates are independent and nearly normal, which 64 samples each are in these scenes (16 are not in the furnace,
/// whose path lengths have a long tail). 4096 pixels: the share of |z| beyond the 97.5% quantile is 5% with a standard
/// deviation of 0.34%. The bounds of 4 such deviations see errors misjudged by 9% (share 3.6% or 6.7%).
TEST(RenderFilm, StandardErrorsTellTheSpreadOfPixelMeans) {
  constexpr double kTolerance = 0.0136;
  for (const auto sampler : {SamplerKind::Independent, SamplerKind::Sobol}) {
    for (const KnownPixels& known : knownPixels()) {
      EXPECT_NEAR(deviationsOf(known, sampler).outside, 0.05, kTolerance)
          << known.scene.name << ", sampler " << static_cast<uint32_t>(sampler);
    }
  }
}

/// One sequence deviates less than eight that know nothing of each other where a pair of numbers decides alone (the
/// floor), and not more elsewhere; and less often than its error bars say. The ratio of two such rms is good to 1.6%.
TEST(RenderFilm, OneSequenceHasLessNoiseUnderWiderErrorBars) {
  for (const KnownPixels& known : knownPixels()) {
    const Deviations joint = deviationsOf(known, SamplerKind::SobolJoint);
    const Deviations eight = deviationsOf(known, SamplerKind::Sobol);
    EXPECT_LT(joint.outside, 0.05) << known.scene.name;
    EXPECT_LT(joint.rms, (known.scene.name == "floor" ? 0.5 : 1.065) * eight.rms) << known.scene.name;
    RecordProperty("outside of " + known.scene.name, std::to_string(joint.outside));
    RecordProperty("noise of " + known.scene.name, std::to_string(joint.rms / eight.rms));
  }
}

/// The device's sums against the planes of the image: another estimate, or half a variance, would differ at once.
TEST(RenderFilm, TheImagesErrorIsThatOfItsPlanes) {
  const Scene scene = cornellBox();
  const Device& device = gpuDevice();
  const GpuScene gpuScene(device, scene);
  Film film(device, {.width = 24, .height = 24});
  PathTracer tracer(device, gpuScene, {.seed = 5});
  tracer.render(cornellCamera(), film, {0, 16});
  const Image image = film.resolve();
  const auto trust = plane(image, "trust.Y");
  double luminance = 0;
  for (size_t i = 0; i < 576; ++i) {
    luminance += 0.2126 * plane(image, "R")[i] + 0.7152 * plane(image, "G")[i] + 0.0722 * plane(image, "B")[i];
  }
  const double e = 0.01 * luminance / 576;
  double square = 0;
  for (const std::string color : {"R", "G", "B"}) {
    const auto means = plane(image, color), errors = plane(image, "stderr." + color);
    for (size_t i = 0; i < 576; ++i) square += double(errors[i]) * errors[i] / (double(means[i]) * means[i] + e * e);
  }
  const ErrorEstimate error = film.error();
  EXPECT_NEAR(error.value, std::sqrt(square / (3 * 576)), 1e-4 * error.value);
  const auto untrusted = std::count_if(trust.begin(), trust.end(), [](float t) { return t < 0.1f; });
  EXPECT_NEAR(error.untrustedShare, double(untrusted) / 576, 1.5 / 576); // a share at the limit may round
  EXPECT_GT(untrusted, 0);
  EXPECT_LT(error.lower, error.value);
  EXPECT_GT(error.upper, error.value);
  EXPECT_GT(film.error(0.99).upper, error.upper);
}

} // namespace
} // namespace isophote
