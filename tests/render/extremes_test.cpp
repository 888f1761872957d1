// Scenes of any size, anywhere, of any brightness, and very long paths.
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "support/render.hpp"
#include "support/scenes.hpp"

namespace isophote {
namespace {

using namespace isophote::test;

/// The Cornell box with every instance and the camera taken along by `map`, a similarity.
Image renderPlacedCornell(const glm::dmat4& map, double scale) {
  Scene scene = cornellBox();
  for (Instance& instance : scene.instances) instance.worldFromObject = map * instance.worldFromObject;
  Camera camera = cornellCamera();
  camera.worldFromCamera[3] = map * camera.worldFromCamera[3];
  camera.znear *= scale;
  return renderImage(scene, camera, 12, 12, 64);
}

/// Largest relative difference of 4 x 4 blocks of green: rounding moves single paths across edges, no more.
double largestBlockDifference(const Image& image, const Image& reference) {
  const std::vector<float> a = plane(image, "G"), b = plane(reference, "G");
  double largest = 0;
  for (uint32_t block = 0; block < 9; ++block) {
    double first = 0, second = 0;
    for (uint32_t i = 0; i < 16; ++i) {
      const size_t at = (block / 3 * 4 + i / 4) * 12 + block % 3 * 4 + i % 4;
      first += double(a[at]);
      second += double(b[at]);
    }
    largest = std::max(largest, std::abs(first / second - 1));
  }
  return largest;
}

// Number 44 of the reliability list. The same random numbers make the same paths at any scale.
TEST(RenderExtremes, Test44TheSameSceneAtScalesFrom2ToMinus20To2To20) {
  const Image reference = renderPlacedCornell(glm::dmat4(1), 1);
  for (const int k : {-20, -7, 9, 20}) {
    const double scale = std::exp2(k);
    const Image image = renderPlacedCornell(glm::scale(glm::dmat4(1), glm::dvec3(scale)), scale);
    EXPECT_LT(largestBlockDifference(image, reference), 1e-3) << k;
  }
}

// Number 45: up to 1e5 times its size away the scene is the same; positions are relative to its center on the device.
TEST(RenderExtremes, Test45TheSameSceneFarFromTheOrigin) {
  const Image reference = renderPlacedCornell(glm::dmat4(1), 1);
  for (const double distance : {1e2, 1e3, 1e5}) {
    const glm::dmat4 map = glm::translate(glm::dmat4(1), distance * glm::dvec3(0.5, -0.7, 0.4));
    EXPECT_LT(largestBlockDifference(renderPlacedCornell(map, 1), reference), 1e-3) << distance;
  }
}

// Number 50: linear over 40 decades, nothing dropped or clipped (renderImage expects that).
TEST(RenderExtremes, Test50LightsFrom1eMinus20To1e20) {
  const auto render = [](float radiance) {
    return plane(renderImage(squareLightOverFloor(radiance), sensorAt({0.2, 0, 0.1}), 8, 8, 64), "G");
  };
  const std::vector<float> reference = render(1);
  for (const float radiance : {1e-20f, 1e-10f, 1e10f, 1e20f}) {
    const std::vector<float> values = render(radiance);
    double sum = 0, expected = 0;
    for (size_t i = 0; i < values.size(); ++i) {
      sum += double(values[i]) / double(radiance);
      expected += double(reference[i]);
    }
    EXPECT_NEAR(sum, expected, 1e-5 * expected) << radiance;
  }
}

// Number 53: 500 scatterings in a box that loses nothing and emits 1: 501 whatever the path, all random numbers of so
// many dimensions in their domain.
TEST(RenderExtremes, Test53FiveHundredScatteringsLoseNothing) {
  for (const auto sampler : {SamplerKind::Sobol, SamplerKind::Independent}) {
    const EstimatorSettings estimator{.sampler = sampler,
                                      .filter = PixelFilter::Box,
                                      .lightSampling = LightSampling::BsdfOnly,
                                      .maxDepth = 500,
                                      .russianRoulette = RussianRoulette::Off};
    const Image image =
        renderImage(boxFurnace(glm::vec3(1), glm::vec3(1)), boxFurnaceCamera(), 8, 8, 8, {.estimator = estimator});
    for (const float value : plane(image, "G")) EXPECT_NEAR(value, 501, 501e-5);
  }
}

} // namespace
} // namespace isophote
