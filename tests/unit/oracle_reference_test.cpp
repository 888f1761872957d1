// The reference tracer against closed forms. Samples are independent, so every check is a z-test of the image's mean
// with 4.9 standard errors (two-sided 1e-6 each); `power` is the smallest relative bias it can see.
#include "oracle/reference_tracer.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "support/scenes.hpp"

namespace isophote::oracle {
namespace {

using namespace isophote::test;

constexpr double kCriticalZ = 4.9;

/// Mean over pixels of one channel with its standard error.
ReferencePixel imageMean(const ReferenceImage& image) {
  ReferencePixel result;
  for (const ReferencePixel& pixel : image.pixels) {
    result.mean += pixel.mean;
    result.standardError += pixel.standardError * pixel.standardError;
  }
  const auto count = static_cast<double>(image.pixels.size());
  result.mean /= count;
  result.standardError = glm::sqrt(result.standardError) / count;
  return result;
}

void expectMean(const ReferenceImage& image, glm::dvec3 expected, double power) {
  const ReferencePixel measured = imageMean(image);
  for (int channel = 0; channel < 3; ++channel) {
    const double halfWidth = kCriticalZ * measured.standardError[channel];
    EXPECT_LE(halfWidth, power * std::abs(expected[channel])) << "inconclusive: too noisy";
    EXPECT_NEAR(measured.mean[channel], expected[channel], halfWidth + 1e-12) << "channel " << channel;
  }
}

TEST(ReferenceTracer, ClosedEmittingBoxGivesLeOverOneMinusRho) {
  const Scene scene = boxFurnace({1, 0.5f, 2}, {0.5f, 0.8f, 0.25f});
  const glm::dvec3 expected(2, 2.5, 2 / 0.75);
  for (const auto mode : {LightSampling::Mis, LightSampling::LightsOnly, LightSampling::BsdfOnly}) {
    const ReferenceSettings settings{.lightSampling = mode};
    // rho is 0.8f, not 0.8: the difference is 1e-8.
    expectMean(renderReference(scene, boxFurnaceCamera(), 8, 8, 8000, settings), expected, 0.016);
  }
}

TEST(ReferenceTracer, DepthLimitCutsTheGeometricSeriesExactly) {
  const Scene scene = boxFurnace(glm::vec3(1), glm::vec3(0.5f));
  for (const uint32_t depth : {0u, 1u, 8u}) {
    const ReferenceSettings settings{.maxDepth = depth, .lightSampling = LightSampling::BsdfOnly};
    const ReferencePixel mean = imageMean(renderReference(scene, boxFurnaceCamera(), 4, 4, 4, settings));
    EXPECT_NEAR(mean.mean.x, 2 - std::pow(0.5, depth), 1e-12);
    EXPECT_LT(mean.standardError.x, 1e-12);
  }
}

TEST(ReferenceTracer, SquareLightGivesLambertsPolygonFormFactor) {
  const Scene scene = squareLightOverFloor(1);
  const auto render = [&](glm::dvec3 point, LightSampling mode) {
    return renderReference(scene, sensorAt(point), 1, 1, 400000, {.lightSampling = mode});
  };
  for (const auto mode : {LightSampling::Mis, LightSampling::LightsOnly, LightSampling::BsdfOnly}) {
    expectMean(render(glm::dvec3(0), mode), glm::dvec3(0.2394564705), 0.015);
    expectMean(render({0.5, 0, 0.5}, mode), glm::dvec3(0.1385323412), 0.02);
  }
}

TEST(ReferenceTracer, PointLightGivesInverseSquareTimesCosine) {
  Scene scene = lambertFloor({0.5f, 0.25f, 1}, 5);
  PunctualLight light;
  light.intensity = {3, 6, 9};
  light.position = {0.4, 2, -0.3};
  scene.lights.push_back(light);
  const ReferenceImage image = renderReference(scene, sensorAt(glm::dvec3(0)), 1, 1, 16);
  const double d2 = 0.4 * 0.4 + 4 + 0.3 * 0.3;
  const double irradiancePerIntensity = 2 / std::sqrt(d2) / d2;
  for (int channel = 0; channel < 3; ++channel) {
    const double rho = scene.materials[0].baseColor[channel];
    EXPECT_NEAR(image.pixels[0].mean[channel],
                rho / 3.141592653589793 * light.intensity[channel] * irradiancePerIntensity, 1e-4);
  }
}

TEST(ReferenceTracer, LambertSphereIsInvisibleInAWhiteFurnace) {
  Scene scene;
  scene.environment = constantEnvironment(glm::vec3(1));
  addPrimitive(scene, sphere(1, 8, false, false, addMaterial(scene, lambert(glm::vec3(1)))));
  for (const auto mode : {LightSampling::Mis, LightSampling::LightsOnly, LightSampling::BsdfOnly})
    expectMean(renderReference(scene, lookAt({0, 0, 4}, {}, 0.6), 8, 8, 16000, {.lightSampling = mode}), glm::dvec3(1),
               0.005);
}

TEST(ReferenceTracer, AlphaLayersMultiply) {
  const Camera camera = orthographicLookAt({0, 0, 3}, {}, 0.5, 0.5);
  expectMean(renderReference(alphaLayers(3, 0.5f), camera, 8, 8, 16000), glm::dvec3(0.125), 0.015);
}

TEST(ReferenceTracer, ResultDoesNotDependOnThreads) {
  const auto render = [](uint32_t threads) {
    return renderReference(cornellBox(), cornellCamera(), 6, 5, 8, {.seed = 9, .threads = threads});
  };
  const ReferenceImage one = render(1), three = render(3);
  for (size_t i = 0; i < one.pixels.size(); ++i) EXPECT_EQ(one.pixels[i].mean, three.pixels[i].mean);
}

TEST(ReferenceTracer, StandardErrorsDescribeTheSpreadBetweenSeeds) {
  // 200 renders of 16 samples: the variance of their means over the mean of their squared standard errors is 1 within
  // 5 standard deviations, sqrt(2 / 199 + kurtosis terms), about 0.15 here: errors misjudged by 40% are seen.
  const Scene scene = cornellBox();
  double sum = 0, squares = 0, reported = 0;
  constexpr int kRuns = 200;
  for (int run = 0; run < kRuns; ++run) {
    const ReferenceImage image =
        renderReference(scene, cornellCamera(), 1, 1, 64, {.seed = 100u + static_cast<uint64_t>(run), .threads = 1});
    sum += image.pixels[0].mean.y;
    squares += image.pixels[0].mean.y * image.pixels[0].mean.y;
    reported += image.pixels[0].standardError.y * image.pixels[0].standardError.y;
  }
  const double variance = (squares - sum * sum / kRuns) / (kRuns - 1);
  EXPECT_NEAR(variance / (reported / kRuns), 1, 0.75);
}

} // namespace
} // namespace isophote::oracle
