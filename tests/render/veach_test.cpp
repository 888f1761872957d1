// Veach's plates: glossy surfaces of four roughnesses under spheres of four sizes (assets/veach-plates.gltf).
#include <array>
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

/// Rows of pixels that lie on a plate, two each, and columns where all of them do.
constexpr std::array<uint32_t, 4> kPlateRows{11, 16, 21, 26};
constexpr uint32_t kFirstColumn = 10, kLastColumn = 38;

/// Mean over a plate's pixels, with the sum of their variances.
Estimate plateMean(const MeasuredImage& image, uint32_t row) {
  Estimate result;
  double count = 0;
  for (uint32_t y = row; y < row + 2; ++y) {
    for (uint32_t x = kFirstColumn; x < kLastColumn; ++x, ++count) {
      const Estimate& pixel = image.pixels[size_t{y} * kWidth + x][1];
      result.mean += pixel.mean;
      result.variance += pixel.variance;
    }
  }
  result.mean /= count;
  result.variance /= count * count;
  return result;
}

// 12 z-tests of plate means, each of 56 pixels x 3072 samples. A difference of 20% shows; on the smoothest plate, which
// light sampling alone knows badly, one of 40%.
TEST(RenderVeach, Test38LightBsdfAndCombinedSamplingAgreePairwise) {
  const Scene scene = loadGltf(assetsFolder() / "veach-plates.gltf");
  const auto image = [&](LightSampling mode, uint64_t seed) {
    return measured(renderPlates(scene, mode, SamplerKind::Independent, 3072, seed));
  };
  const std::array<MeasuredImage, 3> images{image(LightSampling::LightsOnly, 1), image(LightSampling::BsdfOnly, 2),
                                            image(LightSampling::Mis, 3)};
  const double critical = normalTwoSidedQuantile(sidak(testSignificance(), 12));
  for (const uint32_t row : kPlateRows) {
    for (size_t first = 0; first < 3; ++first) {
      const size_t second = (first + 1) % 3;
      const Estimate a = plateMean(images[first], row), b = plateMean(images[second], row);
      const double halfWidth = critical * std::sqrt(a.variance + b.variance);
      EXPECT_NEAR(a.mean, b.mean, halfWidth) << "row " << row << ", images " << first << " and " << second;
      EXPECT_LT(halfWidth, (row == kPlateRows[0] ? 0.4 : 0.2) * b.mean)
          << "row " << row << ", images " << first << " and " << second;
    }
  }
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
