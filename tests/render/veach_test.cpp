// Veach's plates: glossy surfaces of four roughnesses under spheres of four sizes (assets/veach-plates.gltf).
#include <cmath>

#include <gtest/gtest.h>

#include "isophote/gltf.hpp"
#include "support/paths.hpp"
#include "support/render.hpp"

namespace isophote {
namespace {

using namespace isophote::test;

constexpr uint32_t kWidth = 48, kHeight = 32;

Image renderPlates(const Scene& scene, LightSampling mode, SamplerKind sampler, uint32_t samples, uint64_t seed) {
  return renderImage(
      scene, scene.cameras.at(0), kWidth, kHeight, samples,
      {.estimator = {
           .sampler = sampler, .filter = PixelFilter::Box, .lightSampling = mode, .maxDepth = 1, .seed = seed}});
}

/// Mean over pixels of the squared error relative to the squared reference. The plates and what stands behind them are
/// lit everywhere, so no pixel's reference is near zero.
double relativeSquareError(const Image& image, const std::vector<float>& reference) {
  const std::vector<float> values = plane(image, "G");
  Moments error;
  for (size_t i = 0; i < values.size(); ++i) {
    const double difference = double{values[i]} - reference[i];
    error.add(difference * difference / (double{reference[i]} * reference[i] + 1e-4));
  }
  return error.mean();
}

TEST(RenderVeach, Test38LightBsdfAndCombinedSamplingAgreePairwise) {
  const Scene scene = loadGltf(assetsFolder() / "veach-plates.gltf");
  const auto image = [&](LightSampling mode, uint64_t seed) {
    return measured(renderPlates(scene, mode, SamplerKind::Independent, 1024, seed));
  };
  const auto lights = image(LightSampling::LightsOnly, 1), bsdf = image(LightSampling::BsdfOnly, 2),
             both = image(LightSampling::Mis, 3);
  EXPECT_TRUE(sameImage(lights, bsdf, {.powerFloor = 0.03}));
  EXPECT_TRUE(sameImage(lights, both, {.powerFloor = 0.03}));
  EXPECT_TRUE(sameImage(bsdf, both, {.powerFloor = 0.03}));
}

// 16 samples a pixel of independent numbers. The reference has 128 times as many.
TEST(RenderVeach, CombinedSamplingHasTheSmallestErrorAtEqualSamples) {
  const Scene scene = loadGltf(assetsFolder() / "veach-plates.gltf");
  const std::vector<float> reference = plane(renderPlates(scene, LightSampling::Mis, SamplerKind::Sobol, 2048, 9), "G");
  const auto error = [&](LightSampling mode) {
    return relativeSquareError(renderPlates(scene, mode, SamplerKind::Independent, 16, 5), reference);
  };
  const double lights = error(LightSampling::LightsOnly), bsdf = error(LightSampling::BsdfOnly),
               both = error(LightSampling::Mis);
  EXPECT_LT(both, 0.5 * lights) << lights << " " << bsdf << " " << both;
  EXPECT_LT(both, 0.5 * bsdf) << lights << " " << bsdf << " " << both;
}

} // namespace
} // namespace isophote
