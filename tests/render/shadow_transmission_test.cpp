// shadow-transmission=straight: shadow rays that cross glass unbent, and its exact twin.
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "oracle/bsdf_fresnel.hpp"
#include "support/render.hpp"
#include "support/scenes.hpp"

namespace isophote {
namespace {

using namespace isophote::test;

constexpr double kPi = 3.14159265358979323846;

EstimatorSettings straight(LightSampling lights = LightSampling::Mis) {
  EstimatorSettings settings{.filter = PixelFilter::Box, .lightSampling = lights, .seed = 77};
  settings.shadowTransmission = ShadowTransmission::Straight;
  return settings;
}

constexpr double kWide = 50;

/// A white floor under a pane that is wide beyond every path, 0.2 thick or a sheet without thickness.
Scene floorUnderPane(const Material& pane) {
  Scene scene = lambertFloor(glm::vec3(1), kWide);
  const uint32_t material = addMaterial(scene, pane);
  if (pane.volume.thickness > 0) {
    addPrimitive(scene, box({-kWide, 0.6, -kWide}, {kWide, 0.8, kWide}, false, material));
  } else {
    addPrimitive(scene, quad({-kWide, 0.6, kWide}, {2 * kWide, 0, 0}, {0, 0, -2 * kWide}, material));
  }
  return scene;
}

PunctualLight lightAt(glm::dvec3 position) {
  PunctualLight light;
  light.intensity = {3, 6, 9};
  light.position = position;
  return light;
}

// Two boundaries, each with the reflectance of the angle outside, the color once each, and Beer's law along the
// straight line; of a sheet one boundary. Nothing is random, so the tolerance is rounding. The sensor looks from below
// the pane, and one scattering is all there is.
TEST(RenderShadowTransmission, FlatPanesDimAPointLightByReflectionColorAndAbsorption) {
  Material solid = glass(0);
  solid.baseColor = {0.9f, 0.8f, 0.7f, 1};
  solid.volume.attenuationColor = {0.5f, 0.7f, 0.9f};
  solid.volume.attenuationDistance = 0.4f;
  Material rough = solid;
  rough.roughness = 0.5f;
  Material sheet = thinGlass(0.3f);
  sheet.baseColor = {0.9f, 0.8f, 0.7f, 1};
  sheet.transmission.factor = 0.6f;
  EstimatorSettings settings = straight();
  settings.maxDepth = 1;
  for (const glm::dvec3 position : {glm::dvec3(0, 2, 0), glm::dvec3(3, 2, -1)}) {
    const double d = glm::length(position), cosine = position.y / d;
    const double passed = 1 - oracle::fresnelDielectric(cosine, 1.5);
    for (const Material& pane : {solid, rough, sheet}) {
      Scene scene = floorUnderPane(pane);
      scene.lights.push_back(lightAt(position));
      const Image image = renderImage(scene, sensorAt({0, 0, 0}), 4, 4, 16, {.estimator = settings});
      const char* const names[] = {"R", "G", "B"};
      for (int c = 0; c < 3; ++c) {
        const double color = pane.baseColor[c];
        double left = pane.transmission.factor * passed * color;
        if (pane.volume.thickness > 0)
          left = passed * passed * color * color *
                 std::pow(double(pane.volume.attenuationColor[c]), 0.2 / cosine / pane.volume.attenuationDistance);
        const double expected = left * scene.lights[0].intensity[c] * cosine / (d * d) / kPi;
        for (const float value : plane(image, names[c])) ASSERT_NEAR(value, expected, 2e-5 * expected) << names[c];
      }
    }
  }
}

// Where all directions are equally bright, glass that loses nothing changes nothing, however its shadow rays run: what
// they count and what paths still find add up to 1. Counted twice, the light through a pane would be almost 2.
TEST(RenderShadowTransmission, LosslessGlassIsInvisibleInAFurnace) {
  Scene pane = floorUnderPane(glass(0));
  Scene sheet = floorUnderPane(thinGlass(0));
  Scene ball = lambertFloor(glm::vec3(1), kWide);
  addPrimitive(ball, sphere(0.4, 24, true, false, addMaterial(ball, glass(0))),
               glm::translate(glm::dmat4(1), glm::dvec3(0.2, 0.95, 0)));
  for (Scene* scene : {&pane, &sheet, &ball}) scene->environment = constantEnvironment(glm::vec3(1));
  const auto expectWhite = [](const Scene& scene, LightSampling lights, uint32_t samples) {
    const Image image = renderImage(scene, sensorAt({0, 0, 0}), 8, 8, samples, {.estimator = straight(lights)});
    EXPECT_TRUE(pixelMeanIs(image, "G", 1, 0.04)) << static_cast<int>(lights);
  };
  expectWhite(pane, LightSampling::Mis, 128);
  expectWhite(pane, LightSampling::LightsOnly, 128);
  expectWhite(pane, LightSampling::BsdfOnly, 64);
  expectWhite(sheet, LightSampling::Mis, 128);
  expectWhite(ball, LightSampling::Mis, 384);
}

// Rough sheets scatter what they pass, so that shadow rays of their own find the lamp: with those the light would
// count twice. Straight rays do not know roughness.
TEST(RenderShadowTransmission, RoughSheetsPassAsMuchAsSmoothOnes) {
  // Form factor of a parallel rectangle over its corner, four times (Howell, Catalog of Configuration Factors, B-4).
  const double a = 0.05 / 2, side = std::sqrt(1 + a * a);
  const double formFactor = 4 / kPi * a / side * std::atan(a / side);
  const double expected = 100 * formFactor * (1 - oracle::fresnelDielectric(1, 1.5));
  const auto expectDimmed = [&](float roughness, LightSampling lights) {
    Scene scene = floorUnderPane(thinGlass(roughness));
    const uint32_t lamp = addMaterial(scene, emitter(glm::vec3(100)));
    addPrimitive(scene, quad({-0.05, 2, -0.05}, {0.1, 0, 0}, {0, 0, 0.1}, lamp));
    EstimatorSettings settings = straight(lights);
    settings.maxDepth = 2; // the floor and the sheet: no light comes back
    const Image image = renderImage(scene, sensorAt({0, 0, 0}), 8, 8, 64, {.estimator = settings});
    EXPECT_TRUE(pixelMeanIs(image, "G", expected, 0.003)) << roughness;
  };
  expectDimmed(0, LightSampling::Mis);
  expectDimmed(0.6f, LightSampling::Mis);
  expectDimmed(0.6f, LightSampling::LightsOnly);
}

TEST(RenderShadowTransmission, WithoutGlassItChangesNoBit) {
  const Scene scene = squareLightOverFloor(2);
  EstimatorSettings exact = straight();
  exact.shadowTransmission = ShadowTransmission::Off;
  EXPECT_TRUE(bitIdentical(renderImage(scene, sensorAt({0.3, 0, 0}), 8, 8, 16, {.estimator = straight()}),
                           renderImage(scene, sensorAt({0.3, 0, 0}), 8, 8, 16, {.estimator = exact})));
}

/// A ball of glass between a small lamp and the floor: its focus is on the floor.
Scene ballUnderLamp() {
  Scene scene = lambertFloor(glm::vec3(0.5f), 3);
  addPrimitive(scene, sphere(0.5, 24, true, false, addMaterial(scene, glass(0))),
               glm::translate(glm::dmat4(1), glm::dvec3(0, 0.85, 0)));
  PunctualLight lamp = lightAt({0, 4, 0});
  lamp.intensity = glm::vec3(10);
  lamp.radius = 0.3f;
  scene.lights.push_back(lamp);
  return scene;
}

/// Mean radiance of the floor around the focus, seen from below the ball. A number of samples for the exact twin, which
/// finds the lamp by chance; the biased one has little noise.
double floorRadiance(ShadowTransmission transmission, double halfSize, uint32_t samples) {
  EstimatorSettings settings = straight();
  settings.shadowTransmission = transmission;
  settings.maxDepth = 4;
  const Camera below = orthographicLookAt({0, 0.2, 0}, {0, 0, 0}, halfSize, halfSize);
  Moments mean;
  for (const float value : plane(renderImage(ballUnderLamp(), below, 8, 8, samples, {.estimator = settings}), "G"))
    mean.add(value);
  return mean.mean();
}

// What the setting is for, and what it costs: the caustic is gone, and the light in the ball's shadow is the lamp's,
// dimmed as by a pane. The exact twin gathers it below the ball, 37 times as bright.
TEST(RenderShadowTransmission, ABallsFocusIsMissingWhereShadowRaysGoStraight) {
  const double passed = 1 - oracle::fresnelDielectric(1, 1.5);
  const double dimmed = 0.5 / kPi * 10 / 16 * passed * passed;
  EXPECT_NEAR(floorRadiance(ShadowTransmission::Straight, 0.02, 64), dimmed, 0.1 * dimmed);
  EXPECT_GT(floorRadiance(ShadowTransmission::Off, 0.02, 1024), 30 * dimmed);
}

// The light is spread otherwise, not lost: around the whole shadow both have the same mean. The exact one is known to
// about 2%.
TEST(RenderShadowTransmissionSlow, ABallPassesAsMuchLightHoweverItsShadowRaysRun) {
  const double exact = floorRadiance(ShadowTransmission::Off, 0.7, 16384);
  EXPECT_NEAR(floorRadiance(ShadowTransmission::Straight, 0.7, 1024), exact, 0.08 * exact);
}

TEST(RenderShadowTransmissionSlow, SpecializedKernelsGiveTheBitsOfTheFullOnes) {
  Scene scene = ballUnderLamp();
  addPrimitive(scene, quad({-1, 1.7, 1}, {2, 0, 0}, {0, 0, -2}, addMaterial(scene, thinGlass(0.4f))));
  RenderOptions options{.estimator = straight()};
  const Camera camera = lookAt({0, 1, 4}, {0, 0.7, 0}, 0.6);
  const Image specialized = renderImage(scene, camera, 8, 8, 8, options);
  options.execution.specialize = false;
  EXPECT_TRUE(bitIdentical(specialized, renderImage(scene, camera, 8, 8, 8, options)));
}

} // namespace
} // namespace isophote
