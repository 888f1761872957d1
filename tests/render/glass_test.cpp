// Transmission in whole paths: slabs with closed forms, furnaces, and the double-precision tracer.
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "support/render.hpp"
#include "support/scenes.hpp"

namespace isophote {
namespace {

using namespace isophote::test;

constexpr double kDegree = 3.14159265358979323846 / 180;

/// `count` plates of thickness 1 and wide beyond every path, one above the other, over a large emitter of radiance 1
/// that faces up and reflects nothing.
Scene platesOverEmitter(uint32_t count) {
  Scene scene;
  const uint32_t clear = addMaterial(scene, glass(0));
  const uint32_t light = addMaterial(scene, emitter(glm::vec3(1)));
  constexpr double kHalf = 1e3;
  for (uint32_t i = 0; i < count; ++i)
    addPrimitive(scene, box({-kHalf, 2.0 * i + 1, -kHalf}, {kHalf, 2.0 * i + 2, kHalf}, false, clear));
  addPrimitive(scene, quad({-kHalf, 0, kHalf}, {2 * kHalf, 0, 0}, {0, 0, -2 * kHalf}, light));
  return scene;
}

/// Looks at the origin's column from above at `degrees` from the vertical.
Camera obliqueCamera(double height, double degrees, double halfWidth) {
  const double angle = degrees * kDegree;
  const glm::dvec3 target(0, height, 0);
  return orthographicLookAt(target + 3.0 * glm::dvec3(std::sin(angle), std::cos(angle), 1e-3), target, halfWidth,
                            halfWidth);
}

TEST(RenderGlass, Test30SlabTransmitsByTheSeriesOfItsInterfaces) {
  for (const auto& [degrees, expected] :
       {std::pair{0.0, 0.923077}, {45.0, 0.904327}, {60.0, 0.836232}, {80.0, 0.441229}}) {
    // Nothing else shines: what is not transmitted is black.
    const Image image = renderImage(platesOverEmitter(1), obliqueCamera(2, degrees, 0.5), 16, 16, 512);
    EXPECT_TRUE(pixelMeanIs(image, "G", expected, 0.02)) << degrees;
  }
}

TEST(RenderGlass, Test31StackOfTenSlabs) {
  const Image image = renderImage(platesOverEmitter(10), obliqueCamera(20, 0, 0.5), 16, 16, 1024);
  EXPECT_TRUE(pixelMeanIs(image, "R", 0.545455, 0.02));
}

// A ray at 45 degrees leaves a slab shifted by 0.329142 sideways, 0.465477 along the floor: an emitter's edge there is
// seen on one side and not on the other.
TEST(RenderGlass, Test32SlabShiftsABeam) {
  for (const double distance : {-1e-4, 1e-4}) {
    Scene scene;
    addPrimitive(scene, box({-100, 0, -100}, {100, 1, 100}, false, addMaterial(scene, glass(0))));
    // The unshifted ray through (0, 1, 0) meets the emitter at x = -1.001; the shifted one 0.329142 sqrt 2 before.
    const double edge = -1.001 + 0.329142 * std::sqrt(2.0) + distance;
    addPrimitive(scene, quad({edge - 1, -1e-3, 1}, {1, 0, 0}, {0, 0, -2}, addMaterial(scene, emitter(glm::vec3(1)))));
    const Camera camera = orthographicLookAt({1, 2, 0}, {0, 1, 0}, 1e-6, 1e-6);
    const Image image = renderImage(
        scene, camera, 4, 4, 64,
        {.estimator = {.filter = PixelFilter::Box, .maxDepth = 2, .russianRoulette = RussianRoulette::Off}});
    double mean = 0;
    for (const float value : plane(image, "G")) mean += double(value) / 16;
    if (distance < 0) {
      EXPECT_EQ(mean, 0);
    } else {
      EXPECT_NEAR(mean, 0.9, 0.05);
    }
  }
}

Scene glassBoxInFurnace(const Material& material) {
  Scene scene;
  scene.environment = constantEnvironment(glm::vec3(1));
  addPrimitive(scene, box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, false, addMaterial(scene, material)));
  return scene;
}

Camera boxCamera() { return lookAt({1.6, 1.1, 2.1}, {0, 0, 0}, 0.5); }

// A cube of index 1.5 traps light for ever between its faces: roulette ends such paths without bias.
TEST(RenderGlass, Test20SmoothGlassIsInvisibleInAFurnace) {
  EXPECT_TRUE(pixelMeanIs(renderImage(glassBoxInFurnace(glass(0)), boxCamera(), 16, 16, 64), "G", 1, 0.02));
  EXPECT_TRUE(pixelMeanIs(renderImage(glassBoxInFurnace(thinGlass(0)), boxCamera(), 16, 16, 64), "G", 1, 0.02));
}

TEST(RenderGlass, Test49IndexOneIsInvisibleToTheBit) {
  for (const float roughness : {0.0f, 0.4f}) {
    const Image image = renderImage(glassBoxInFurnace(glass(roughness, 1)), boxCamera(), 8, 8, 16);
    for (const float value : plane(image, "G")) ASSERT_EQ(value, 1);
  }
}

// Where all directions are equally bright, light samples only add noise.
const RenderOptions bsdfOnly{
    .estimator = {.filter = PixelFilter::Box, .lightSampling = LightSampling::BsdfOnly, .seed = 1}};

void expectRoughGlassBoxAsTheReference(float alpha, uint32_t samples, double powerFloor) {
  const Scene scene = glassBoxInFurnace(glass(std::sqrt(alpha)));
  const auto reference = oracle::renderReference(scene, boxCamera(), 16, 16, samples,
                                                 {.lightSampling = LightSampling::BsdfOnly, .seed = 21});
  const Image image = renderImage(scene, boxCamera(), 16, 16, samples, bsdfOnly);
  EXPECT_TRUE(sameImage(measured(image), measured(reference), {.powerFloor = powerFloor})) << alpha;
}

TEST(RenderGlass, Test21RoughGlassBoxMatchesTheReference) {
  for (const float alpha : {0.05f, 0.3f, 0.6f}) expectRoughGlassBoxAsTheReference(alpha, 512, 0.02);
}

TEST(RenderGlass, Test21RoughGlassBoxMatchesTheReferenceSlow) {
  expectRoughGlassBoxAsTheReference(0.05f, 2048, 0.003);
  expectRoughGlassBoxAsTheReference(0.3f, 6144, 0.003);
  expectRoughGlassBoxAsTheReference(0.6f, 12288, 0.003);
}

// Lights found through rough glass by light samples, by BSDF samples, and by both.
TEST(RenderGlass, LightIsFoundThroughRoughGlassByEveryTechnique) {
  Scene scene;
  Material pane = glass(0.5f);
  pane.baseColor = {0.9f, 0.6f, 0.3f, 1};
  addPrimitive(scene, box({-1, 0.4, -1}, {1, 0.6, 1}, false, addMaterial(scene, pane)));
  Material sheet = thinGlass(0.4f);
  sheet.transmission.factor = 0.7f;
  addPrimitive(scene, quad({-1, 0.2, 1}, {2, 0, 0}, {0, 0, -2}, addMaterial(scene, sheet)));
  addPrimitive(scene, quad({-0.4, 0, 0.4}, {0.8, 0, 0}, {0, 0, -0.8}, addMaterial(scene, emitter(glm::vec3(2)))));
  const Camera camera = lookAt({0.3, 2.5, 0.8}, {0, 0.5, 0}, 0.5);
  const auto reference = oracle::renderReference(scene, camera, 8, 8, 8192, {.seed = 38});
  for (const auto mode : {LightSampling::Mis, LightSampling::LightsOnly, LightSampling::BsdfOnly}) {
    const Image image = renderImage(scene, camera, 8, 8, 4096,
                                    {.estimator = {.filter = PixelFilter::Box, .lightSampling = mode, .seed = 5}});
    EXPECT_TRUE(sameImage(measured(image), measured(reference),
                          {.powerFloor = mode == LightSampling::LightsOnly ? 0.09 : 0.03}))
        << static_cast<int>(mode);
  }
}

// Radiance inside a medium of index n is n^2 times that outside. The camera looks within the critical angle of the face
// ahead: directions beyond those of all faces stay in the cube, and no light gets into them.
TEST(RenderGlass, Test33InsideGlassAFurnaceShowsTheSquaredIndex) {
  const Camera inside = lookAt({0.1, 0.05, -0.1}, {0.5, 0.07, -0.12}, 0.5);
  EXPECT_TRUE(pixelMeanIs(renderImage(glassBoxInFurnace(glass(0)), inside, 16, 16, 256), "G", 2.25, 0.03));
}

// A row of flat-faced balls for each lossless material, roughness rising along it: every view of every facet is 1.
TEST(RenderGlass, Test20LosslessMaterialsAreInvisibleInAFurnace) {
  constexpr uint32_t kCell = 8;
  const float roughnesses[] = {0, 0.05f, 0.2f, 0.5f, 1};
  Scene scene;
  scene.environment = constantEnvironment(glm::vec3(1));
  for (uint32_t column = 0; column < 5; ++column) {
    const float roughness = roughnesses[column];
    const Material rows[] = {metal(glm::vec3(1), roughness), dielectric(glm::vec3(1), roughness), glass(roughness),
                             thinGlass(roughness)};
    for (uint32_t row = 0; row < 4; ++row)
      addPrimitive(scene, sphere(1, 12, false, false, addMaterial(scene, rows[row])),
                   glm::translate(glm::dmat4(1), glm::dvec3(2.0 * column - 4, 3 - 2.0 * row, 0)));
  }
  const Camera camera = orthographicLookAt({0, 0, 10}, {0, 0, 0}, 5, 4);
  const Image image = renderImage(scene, camera, 5 * kCell, 4 * kCell, 1024, bsdfOnly);
  const std::vector<float> values = plane(image, "G");
  for (uint32_t row = 0; row < 4; ++row) {
    for (uint32_t column = 0; column < 5; ++column) {
      Moments cell;
      for (uint32_t i = 0; i < kCell * kCell; ++i)
        cell.add(double(values[(row * kCell + i / kCell) * 5 * kCell + column * kCell + i % kCell]));
      EXPECT_LT(cell.standardError(), 0.007) << row << ", roughness " << roughnesses[column];
      EXPECT_NEAR(cell.mean(), 1, 0.01 + 2 * cell.standardError()) << row << ", roughness " << roughnesses[column];
    }
  }
}

// KHR_materials_dispersion: each color is the render of a glass with its own index, (ior - 1) (1 -+ 0.025 dispersion)
// + 1.
TEST(RenderGlass, DispersionIsThreeMonochromeRenders) {
  const auto scene = [](float ior, float dispersion) {
    Scene result;
    Material material = glass(0.2f, ior);
    material.dispersion = dispersion;
    addPrimitive(result, box({-0.5, 0.5, -0.5}, {0.5, 1, 0.5}, false, addMaterial(result, material)),
                 glm::rotate(glm::dmat4(1), 0.5, glm::dvec3(0, 0, 1)));
    addPrimitive(result, quad({-1, 0.05, 0.5}, {0.9, 0, 0}, {0, 0, -1}, addMaterial(result, emitter(glm::vec3(1)))));
    return result;
  };
  const Camera camera = lookAt({0.2, 3, 0.5}, {-0.2, 0.7, 0}, 0.35);
  constexpr float kDispersion = 8; // iors 1.4, 1.5, 1.6
  const MeasuredImage dispersed = measured(renderImage(scene(1.5f, kDispersion), camera, 8, 8, 4096));
  MeasuredImage expected = dispersed;
  for (size_t channel = 0; channel < 3; ++channel) {
    const float ior = 1.5f + 0.1f * (static_cast<float>(channel) - 1);
    const MeasuredImage mono = measured(
        renderImage(scene(ior, 0), camera, 8, 8, 1024, {.estimator = {.filter = PixelFilter::Box, .seed = 7}}));
    for (size_t i = 0; i < mono.pixels.size(); ++i) expected.pixels[i][channel] = mono.pixels[i][channel];
  }
  EXPECT_TRUE(sameImage(dispersed, expected, {.powerFloor = 0.03}));
  const auto reference = oracle::renderReference(scene(1.5f, kDispersion), camera, 8, 8, 2048, {.seed = 3});
  EXPECT_TRUE(sameImage(dispersed, measured(reference), {.powerFloor = 0.06}));
}

// A slab's shift grows with the index: an emitter's edge between the exits of red and blue is seen in one color.
TEST(RenderGlass, DispersionBendsBlueMoreThanRed) {
  Scene scene;
  Material material = glass(0);
  material.dispersion = 8;
  addPrimitive(scene, box({-100, 0, -100}, {100, 1, 100}, false, addMaterial(scene, material)));
  const auto exitAt = [](double ior) { return -std::tan(std::asin(std::sin(45 * kDegree) / ior)) - 1e-3; };
  const double edge = 0.5 * (exitAt(1.5) + exitAt(1.6));
  addPrimitive(scene, quad({edge - 1, -1e-3, 1}, {1, 0, 0}, {0, 0, -2}, addMaterial(scene, emitter(glm::vec3(1)))));
  const Camera camera = orthographicLookAt({1, 2, 0}, {0, 1, 0}, 1e-6, 1e-6);
  const Image image = renderImage(scene, camera, 4, 4, 256, {.estimator = {.filter = PixelFilter::Box, .maxDepth = 2}});
  double red = 0, green = 0, blue = 0;
  for (const float value : plane(image, "R")) red += double(value) / 16;
  for (const float value : plane(image, "G")) green += double(value) / 16;
  for (const float value : plane(image, "B")) blue += double(value) / 16;
  EXPECT_NEAR(red, 0.9, 0.1); // further out along the ray: red bends least
  EXPECT_NEAR(green, 0.9, 0.1);
  EXPECT_EQ(blue, 0);
}

TEST(RenderGlass, SpecializedKernelsGiveTheBitsOfTheFullOnes) {
  Scene scene = glassBoxInFurnace(glass(0.3f));
  addPrimitive(scene, quad({-1, -0.6, 1}, {2, 0, 0}, {0, 0, -2}, addMaterial(scene, thinGlass(0))));
  RenderOptions full;
  full.execution.specialize = false;
  EXPECT_TRUE(
      bitIdentical(renderImage(scene, boxCamera(), 12, 12, 16), renderImage(scene, boxCamera(), 12, 12, 16, full)));
}

} // namespace
} // namespace isophote
