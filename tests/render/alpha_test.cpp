// Masked and blended surfaces.
#include <cmath>

#include <gtest/gtest.h>

#include "support/render.hpp"
#include "support/scenes.hpp"

namespace isophote {
namespace {

using namespace isophote::test;

TEST(RenderAlpha, Test36BlackLayersOfOpacityAHalfLeaveAHalfEach) {
  const Camera camera = orthographicLookAt({0, 0, 3}, {}, 0.5, 0.5);
  for (const uint32_t layers : {1u, 2u, 3u, 6u}) {
    const Image image = renderImage(alphaLayers(layers, 0.5f), camera, 16, 16, 4096);
    const double expected = std::pow(0.5, layers);
    SCOPED_TRACE(layers);
    EXPECT_TRUE(pixelMeanIs(image, "R", expected, 0.005 * std::sqrt(1 / expected)));
  }
}

TEST(RenderAlpha, Test36OpacityIsTheFactorItself) {
  const Camera camera = orthographicLookAt({0, 0, 3}, {}, 0.5, 0.5);
  for (const float alpha : {0.0f, 0.1f, 0.9f, 1.0f}) {
    const Image image = renderImage(alphaLayers(2, alpha), camera, 16, 16, 4096);
    const double expected = std::pow(1 - double(alpha), 2);
    SCOPED_TRACE(alpha);
    if (expected == 0) {
      for (const float value : plane(image, "G")) ASSERT_EQ(value, 0);
    } else {
      EXPECT_TRUE(pixelMeanIs(image, "G", expected, 0.05));
    }
  }
}

/// A floor lit by a square light through a sheet of the given material at half height.
Scene shadedFloor(const Material& sheet, uint32_t& sheetMaterial) {
  Scene scene = squareLightOverFloor(2);
  sheetMaterial = addMaterial(scene, sheet);
  addPrimitive(scene, quad({-1, 0.75, -1}, {2, 0, 0}, {0, 0, 2}, sheetMaterial));
  return scene;
}

TEST(RenderAlpha, ShadowRaysSeeTheSameOpacityAsPaths) {
  Material sheet = lambert(glm::vec3(0));
  sheet.baseColor.w = 0.3f;
  sheet.alphaMode = AlphaMode::Blend;
  uint32_t material = 0;
  const Scene scene = shadedFloor(sheet, material);
  for (const auto mode : {LightSampling::Mis, LightSampling::LightsOnly, LightSampling::BsdfOnly}) {
    const bool blind = mode == LightSampling::BsdfOnly;
    const Image image = renderImage(scene, sensorAt({0, 0, 0}), 8, 8, blind ? 16384 : 8192,
                                    {.estimator = {.filter = PixelFilter::Box, .lightSampling = mode, .seed = 5}});
    EXPECT_TRUE(pixelMeanIs(image, "R", 2 * 0.2394564705 * (1 - double(0.3f)), blind ? 0.015 : 0.006));
  }
}

TEST(RenderAlpha, BlendedAndMaskedEmittersShineOnlyWhereTheyAre) {
  // The light itself is half there: by every way of finding it, it gives half the irradiance.
  Scene scene = squareLightOverFloor(2);
  scene.materials[1].baseColor.w = 0.5f;
  for (const auto mode : {LightSampling::Mis, LightSampling::LightsOnly, LightSampling::BsdfOnly}) {
    const bool blind = mode == LightSampling::BsdfOnly;
    const RenderOptions options{.estimator = {.filter = PixelFilter::Box, .lightSampling = mode, .seed = 6}};
    scene.materials[1].alphaMode = AlphaMode::Blend;
    const Image blended = renderImage(scene, sensorAt({0, 0, 0}), 8, 8, blind ? 16384 : 8192, options);
    EXPECT_TRUE(pixelMeanIs(blended, "R", 0.2394564705, blind ? 0.02 : 0.006));
    scene.materials[1].alphaMode = AlphaMode::Mask;
    scene.materials[1].alphaCutoff = 0.6f;
    const Image masked = renderImage(scene, sensorAt({0, 0, 0}), 8, 8, 64, options);
    for (const float value : plane(masked, "R")) ASSERT_EQ(value, 0);
  }
}

TEST(RenderAlpha, MaskIsPresentFromItsCutoffOn) {
  const Camera camera = orthographicLookAt({0, 0, 3}, {}, 0.5, 0.5);
  Scene scene = alphaLayers(1, 0.5f);
  scene.materials[1].alphaMode = AlphaMode::Mask;
  for (const float cutoff : {0.25f, 0.5f, 0.75f}) {
    scene.materials[1].alphaCutoff = cutoff;
    const Image image = renderImage(scene, camera, 4, 4, 16);
    for (const float value : plane(image, "R")) ASSERT_EQ(value, cutoff <= 0.5f ? 0.0f : 1.0f);
  }
}

} // namespace
} // namespace isophote
