// The Cornell box against the double-precision tracer, and the three ways of finding lights against each other.
#include <gtest/gtest.h>

#include "support/render.hpp"
#include "support/scenes.hpp"

namespace isophote {
namespace {

using namespace isophote::test;

/// Sees the lower part of the box but not the lamp, whose edges would be the noisiest pixels of the image by far.
Camera cornellLowerCamera() { return lookAt({0.278, 0.273, -0.8}, {0.278, 0.17, 0}, 0.5); }

RenderOptions withEstimator(const EstimatorSettings& estimator) { return {.estimator = estimator}; }

TEST(RenderCornell, Test29EveryPixelMatchesTheReference) {
  const Scene scene = cornellBox();
  const auto reference = oracle::renderReference(scene, cornellLowerCamera(), 32, 32, 2048, {.seed = 29});
  for (const auto sampler : {SamplerKind::Sobol, SamplerKind::SobolJoint, SamplerKind::Independent}) {
    const Image image = renderImage(scene, cornellLowerCamera(), 32, 32, 1024,
                                    withEstimator({.sampler = sampler, .filter = PixelFilter::Box, .seed = 29}));
    EXPECT_TRUE(sameImage(measured(image), measured(reference), {.powerFloor = 0.006}));
  }
}

TEST(RenderCornell, Test29DirectLightMatchesTheReference) {
  const Scene scene = cornellBox();
  for (const uint32_t depth : {1u, 2u}) {
    const auto reference =
        oracle::renderReference(scene, cornellLowerCamera(), 32, 32, 1024, {.maxDepth = depth, .seed = 2});
    const Image image = renderImage(scene, cornellLowerCamera(), 32, 32, 512,
                                    withEstimator({.filter = PixelFilter::Box, .maxDepth = depth, .seed = 2}));
    EXPECT_TRUE(sameImage(measured(image), measured(reference), {.powerFloor = 0.008}));
  }
}

TEST(RenderCornell, Test38ThreeWaysOfFindingLightsAgree) {
  const auto render = [](LightSampling mode, MisHeuristic heuristic, uint32_t samples) {
    return measured(renderImage(cornellBox(), cornellLowerCamera(), 16, 16, samples,
                                withEstimator({.filter = PixelFilter::Box,
                                               .lightSampling = mode,
                                               .misHeuristic = heuristic,
                                               .seed = 38 + static_cast<uint64_t>(mode)})));
  };
  const MeasuredImage power = render(LightSampling::Mis, MisHeuristic::Power, 1024);
  const MeasuredImage balance = render(LightSampling::Mis, MisHeuristic::Balance, 1024);
  const MeasuredImage lights = render(LightSampling::LightsOnly, MisHeuristic::Power, 1024);
  const MeasuredImage bsdf = render(LightSampling::BsdfOnly, MisHeuristic::Power, 8192);
  EXPECT_TRUE(sameImage(power, balance, {.powerFloor = 0.015}));
  EXPECT_TRUE(sameImage(power, lights, {.powerFloor = 0.015}));
  EXPECT_TRUE(sameImage(power, bsdf, {.powerFloor = 0.04}));
  EXPECT_TRUE(sameImage(lights, bsdf, {.powerFloor = 0.04}));
}

TEST(RenderCornellSlow, Test29FullSizeMatchesTheReference) {
  const Scene scene = cornellBox();
  const Image image = renderImage(scene, cornellCamera(), 256, 256, 1024);
  const auto reference = oracle::renderReference(scene, cornellCamera(), 256, 256, 1024, {.seed = 29});
  EXPECT_TRUE(sameImage(measured(image), measured(reference), {.powerFloor = 0.003}));
}

} // namespace
} // namespace isophote
