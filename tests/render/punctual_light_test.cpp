// Point, spot and directional lights (KHR_lights_punctual).
#include <cmath>

#include <gtest/gtest.h>

#include "support/render.hpp"
#include "support/scenes.hpp"

namespace isophote {
namespace {

using namespace isophote::test;

constexpr double kPi = 3.14159265358979323846;

/// A floor of reflectance (0.5, 0.25, 1) around the origin under one light: radiance has no variance but the tiny
/// view's.
void expectFloorRadiance(const PunctualLight& light, double irradiancePerIntensity) {
  Scene scene = lambertFloor({0.5f, 0.25f, 1}, 5);
  scene.lights.push_back(light);
  const Image image =
      renderImage(scene, sensorAt({0, 0, 0}), 4, 4, 64); // of the rounding to the film's unit a mean is left
  const char* const names[] = {"R", "G", "B"};
  for (int c = 0; c < 3; ++c) {
    const double rho = scene.materials[0].baseColor[c];
    const double expected = rho / kPi * light.intensity[c] * irradiancePerIntensity;
    for (const float value : plane(image, names[c])) ASSERT_NEAR(value, expected, 1e-5 * expected + 1e-30) << names[c];
    for (const float error : plane(image, std::string("stderr.") + names[c])) ASSERT_LE(error, 1e-5 * expected);
  }
}

PunctualLight makeLight(LightKind kind) {
  PunctualLight light;
  light.kind = kind;
  light.intensity = {3, 6, 9};
  return light;
}

TEST(RenderPunctual, Test26PointLightIsInverseSquareTimesCosine) {
  PunctualLight light = makeLight(LightKind::Point);
  light.position = {0, 2, 0};
  expectFloorRadiance(light, 0.25);
  light.range = 4; // recommended window: 1 - (d / range)^4
  expectFloorRadiance(light, 0.25 * (1 - std::pow(0.5, 4)));
  light.range = 1.5f;
  expectFloorRadiance(light, 0);
}

TEST(RenderPunctual, Test26PointLightFromTheSide) {
  PunctualLight light = makeLight(LightKind::Point);
  light.position = {3, 0.25, -4}; // cosine 0.05: the offset of the ray's origin must not shade it
  const double d = glm::length(light.position);
  expectFloorRadiance(light, 0.25 / (d * d * d));
}

TEST(RenderPunctual, Test26DirectionalLightIsIrradianceTimesCosine) {
  PunctualLight light = makeLight(LightKind::Directional);
  light.direction = glm::normalize(glm::dvec3(1, -2, 0.5));
  expectFloorRadiance(light, -light.direction.y);
  light.direction = glm::normalize(glm::dvec3(1, 2, 0.5)); // from below
  expectFloorRadiance(light, 0);
}

TEST(RenderPunctual, Test26SpotLightFollowsTheRecommendedFalloff) {
  PunctualLight light = makeLight(LightKind::Spot);
  light.position = {0, 2, 0};
  light.innerConeAngle = 0.3f;
  light.outerConeAngle = 0.8f;
  const auto aimAside = [&](double angle) { light.direction = {std::sin(angle), -std::cos(angle), 0}; };
  aimAside(0.25);
  expectFloorRadiance(light, 0.25);
  aimAside(0.85);
  expectFloorRadiance(light, 0);
  aimAside(0.55);
  const double inner = std::cos(double(0.3f)), outer = std::cos(double(0.8f));
  const double share = (std::cos(0.55) - outer) / (inner - outer);
  expectFloorRadiance(light, 0.25 * share * share);
}

TEST(RenderPunctual, OccludedLightsCastBlackShadows) {
  Scene scene = lambertFloor(glm::vec3(1), 5);
  addPrimitive(scene, quad({-0.1, 1, -0.1}, {0.2, 0, 0}, {0, 0, 0.2}, 0));
  for (const auto kind : {LightKind::Point, LightKind::Directional}) {
    PunctualLight light = makeLight(kind);
    light.position = {0, 3, 0};
    light.direction = {0, -1, 0};
    scene.lights = {light};
    const EstimatorSettings direct{.filter = PixelFilter::Box, .maxDepth = 1};
    const Image image = renderImage(scene, sensorAt({0, 0, 0}), 4, 4, 16, {.estimator = direct});
    for (const float value : plane(image, "R")) ASSERT_EQ(value, 0);
  }
}

TEST(RenderPunctual, Test19PointLightInATessellatedSphereMatchesTheReference) {
  // The smooth sphere would give exactly 1: I = pi, rho = 0.5, E = I, L = rho E / pi / (1 - rho). Of 16 rings the value
  // is a few percent away and varies over the facets, so the reference tracer decides.
  const Scene scene = sphereWithPointLight(static_cast<float>(kPi), 0.5f, 16);
  const Camera camera = lookAt({0.3, 0.2, 0.1}, {-1, -0.2, 0.3}, 1.2);
  const Image image = renderImage(scene, camera, 16, 16, 2048);
  const auto reference = oracle::renderReference(scene, camera, 16, 16, 2048);
  EXPECT_TRUE(sameImage(measured(image), measured(reference)));
  Moments mean;
  for (const float value : plane(image, "G")) mean.add(value);
  EXPECT_NEAR(mean.mean(), 1, 0.08);
}

TEST(RenderPunctual, ThreeKindsOfLightMatchTheReference) {
  const Scene scene = punctualStillLife();
  const Camera camera = punctualStillLifeCamera();
  const Image image = renderImage(scene, camera, 32, 24, 1024);
  const auto reference = oracle::renderReference(scene, camera, 32, 24, 1024);
  EXPECT_TRUE(sameImage(measured(image), measured(reference), {.powerFloor = 0.012}));
}

} // namespace
} // namespace isophote
