// Lights of KHR_lights_punctual with a radius: spheres and suns.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "isophote/sky.hpp"
#include "support/render.hpp"
#include "support/scenes.hpp"

namespace isophote {
namespace {

using namespace isophote::test;

constexpr double kPi = 3.14159265358979323846;

/// A sphere light of radiance `L`.
PunctualLight sphereLight(glm::dvec3 position, double radius, double L) {
  PunctualLight light;
  light.kind = LightKind::Point;
  light.position = position;
  light.radius = static_cast<float>(radius);
  light.intensity = glm::vec3(static_cast<float>(L * kPi * radius * radius));
  return light;
}

PunctualLight sun(glm::dvec3 direction, double angularRadius, float irradiance) {
  PunctualLight light;
  light.kind = LightKind::Directional;
  light.direction = glm::normalize(direction);
  light.radius = static_cast<float>(angularRadius);
  light.intensity = glm::vec3(irradiance);
  return light;
}

Scene floorUnder(const PunctualLight& light) {
  Scene scene = lambertFloor(glm::vec3(1), 5);
  scene.lights.push_back(light);
  return scene;
}

struct Estimator {
  LightSampling lights;
  SphereLightSampling spheres;
  SamplerKind sampler;

  [[nodiscard]] EstimatorSettings settings() const {
    return {.sampler = sampler,
            .filter = PixelFilter::Box,
            .lightSampling = lights,
            .sphereLightSampling = spheres,
            .maxDepth = 1,
            .seed = 24};
  }
};

std::string estimatorName(const testing::TestParamInfo<Estimator>& info) {
  const char* const lights[] = {"Mis", "LightsOnly", "BsdfOnly"};
  const char* const spheres[] = {"Cone", "Area"};
  const char* const samplers[] = {"Sobol", "Independent"};
  return std::string(lights[static_cast<size_t>(info.param.lights)]) +
         spheres[static_cast<size_t>(info.param.spheres)] + samplers[static_cast<size_t>(info.param.sampler)];
}

/// Closed forms hold for every way to sample lights and every source of random numbers. Light that only the cosine
/// lobe looks for, or that is sampled by area, is seen to 1.5%, other light to 0.4%; without Sobol's stratification to
/// twice and four times that.
class SizedLights : public testing::TestWithParam<Estimator> {
protected:
  static void expectRadiance(const Scene& scene, double expected) {
    const Estimator& estimator = GetParam();
    const bool noisy = estimator.lights == LightSampling::BsdfOnly || estimator.spheres == SphereLightSampling::Area;
    const Image image =
        renderImage(scene, sensorAt({0, 0, 0}), 8, 8, noisy ? 4096 : 1024, {.estimator = estimator.settings()});
    const bool plain = estimator.sampler == SamplerKind::Independent;
    EXPECT_TRUE(pixelMeanIs(image, "R", expected, noisy ? (plain ? 0.03 : 0.015) : (plain ? 0.016 : 0.004)));
  }
};

TEST_P(SizedLights, Test24SphereGivesItsIrradianceOverheadAndTouchingTheHorizon) {
  const double L = 3;
  expectRadiance(floorUnder(sphereLight({0, 2, 0}, 1, L)), L * 0.785398163 / kPi);
  expectRadiance(floorUnder(sphereLight({std::sqrt(3.0), 1, 0}, 1, L)), L * 0.392699082 / kPi);
}

TEST_P(SizedLights, TheInsideOfASphereIsAFurnace) {
  expectRadiance(floorUnder(sphereLight({0.3, 0.5, -0.4}, 2, 3)), 3);
}

TEST_P(SizedLights, ASunsIrradianceIsItsIntensityTimesTheCosine) {
  expectRadiance(floorUnder(sun({0, -1, 0}, 0.5, 3)), 3 / kPi);
  expectRadiance(floorUnder(sun({std::sqrt(3.0), -1, 0}, 0.5, 3)), 3 / kPi / 2);
}

INSTANTIATE_TEST_SUITE_P(
    RenderSizedLight, SizedLights,
    testing::Values(Estimator{LightSampling::Mis, SphereLightSampling::Cone, SamplerKind::Sobol},
                    Estimator{LightSampling::LightsOnly, SphereLightSampling::Cone, SamplerKind::Sobol},
                    Estimator{LightSampling::BsdfOnly, SphereLightSampling::Cone, SamplerKind::Sobol},
                    Estimator{LightSampling::Mis, SphereLightSampling::Area, SamplerKind::Sobol},
                    Estimator{LightSampling::LightsOnly, SphereLightSampling::Area, SamplerKind::Sobol},
                    Estimator{LightSampling::Mis, SphereLightSampling::Cone, SamplerKind::Independent},
                    Estimator{LightSampling::LightsOnly, SphereLightSampling::Area, SamplerKind::Independent},
                    Estimator{LightSampling::BsdfOnly, SphereLightSampling::Cone, SamplerKind::Independent}),
    estimatorName);

// From afar the light sample has no variance left, so a bias of 1e-4 would show.
TEST(RenderSizedLight, Test25SmallSpheresFarAwayKeepTheirIrradiance) {
  for (const double ratio : {1e2, 1e4, 1e5}) {
    const double d = 100, r = d / ratio;
    const double L = ratio * ratio; // E = pi
    for (const auto mode : {LightSampling::Mis, LightSampling::LightsOnly}) {
      const Image image = renderImage(floorUnder(sphereLight({0, d, 0}, r, L)), sensorAt({0, 0, 0}), 8, 8, 256,
                                      {.estimator = {.filter = PixelFilter::Box, .lightSampling = mode}});
      Moments mean;
      for (const float value : plane(image, "R")) mean.add(value);
      // Rounding to the film's unit, a share of the largest radiance, is noise of mean 0.
      const double unit = L * std::exp2(-35);
      EXPECT_NEAR(mean.mean(), 1, 1e-4 + unit / std::sqrt(256.0 * 64) * 4) << ratio;
    }
  }
}

TEST(RenderSizedLight, SmallSunsKeepTheirIrradiance) {
  for (const double radius : {1e-1, 4.65e-3, 1e-4, 1e-5}) {
    const Image image = renderImage(floorUnder(sun({0, -1, 0}, radius, 2)), sensorAt({0, 0, 0}), 8, 8, 256);
    Moments mean;
    for (const float value : plane(image, "R")) mean.add(value);
    const double unit = 2 / (kPi * radius * radius) * std::exp2(-35);
    EXPECT_NEAR(mean.mean(), 2 / kPi, 1e-4 + 0.02 * radius * radius + unit / std::sqrt(256.0 * 64) * 4) << radius;
  }
}

// The sun of --sky is a disk of its real size: straight ahead and in a mirror its radiance is the illuminance over
// pi sin^2 a; what the view receives of it, and what a floor receives, is what the sun without a size would give.
TEST(RenderSizedLight, TheSkysSunIsADiskOfItsIlluminance) {
  const Sky sky = makeSky({.elevationDegrees = 35, .azimuthDegrees = 60, .turbidity = 3});
  const double angle = kSunAngularRadius;
  EXPECT_NEAR(angle * 180 / kPi, 0.2665, 1e-4);
  const double illuminance = sky.sun.intensity.g, L = illuminance / (kPi * std::pow(std::sin(angle), 2));
  const glm::dvec3 toSun = -sky.sun.direction;

  Scene empty;
  empty.lights = {sky.sun};
  const double half = 2 * angle; // of the view
  const Image ahead = renderImage(empty, lookAt({0, 0, 0}, toSun, 2 * half), 32, 32, 64);
  const std::vector<float> values = plane(ahead, "G");
  EXPECT_NEAR(values[16 * 32 + 16], L, 1e-5 * L);
  EXPECT_EQ(values[0], 0);
  double received = 0;
  for (const float value : values) received += double(value) * std::pow(2 * std::tan(half) / 32, 2);
  EXPECT_NEAR(received, illuminance, 2e-3 * illuminance);

  Scene mirrored = empty; // a mirror that turns the view upwards into the sun
  const glm::dvec3 forward(0, 0, -1);
  const glm::dvec3 normal = glm::normalize(toSun - forward);
  const glm::dvec3 u = glm::normalize(glm::cross(glm::dvec3(0, 1, 0), normal)), v = glm::cross(normal, u);
  addPrimitive(mirrored, quad(2.0 * forward - u - v, 2.0 * u, 2.0 * v, addMaterial(mirrored, metal(glm::vec3(1), 0))));
  const Image seen = renderImage(mirrored, lookAt({0, 0, 0}, forward, 1e-4), 4, 4, 16);
  for (const float value : plane(seen, "G")) EXPECT_NEAR(value, L, 1e-4 * L);

  const Image lit = renderImage(floorUnder(sky.sun), sensorAt({0, 0, 0}), 8, 8, 256);
  Moments mean;
  for (const float value : plane(lit, "G")) mean.add(value);
  EXPECT_NEAR(mean.mean(), illuminance * toSun.y / kPi, 2e-4 * illuminance);
}

/// A floor and a glossy plate under three spheres, one a spotlight, one with a range, one of them half sunk into the
/// floor and in front of another; and a sun. The camera sees them.
Scene sizedStillLife() {
  Scene scene = lambertFloor({0.8f, 0.7f, 0.6f}, 3);
  const uint32_t gloss = addMaterial(scene, metal(glm::vec3(0.9f), 0.25f));
  const uint32_t block = addMaterial(scene, lambert(glm::vec3(0.5f)));
  addPrimitive(scene, quad({-2, 0, -1.8}, {4, 0, 0}, {0, 1.6, -0.8}, gloss));
  addPrimitive(scene, box({-0.9, 0, -0.6}, {-0.5, 0.8, -0.2}, false, block));
  scene.lights = {sphereLight({-1.2, 1.2, 0.3}, 0.25, 6), sphereLight({0.9, 0.1, -0.3}, 0.3, 4),
                  sphereLight({0.2, 1.6, -0.8}, 0.2, 30), sun({0.4, -1, -0.3}, 0.1, 0.6f)};
  scene.lights[0].range = 3;
  scene.lights[2].kind = LightKind::Spot;
  scene.lights[2].direction = glm::normalize(glm::dvec3(0.3, -1, 0.2));
  scene.lights[2].innerConeAngle = 0.4f;
  scene.lights[2].outerConeAngle = 1.1f;
  return scene;
}

Camera sizedStillLifeCamera() { return lookAt({0.1, 1.3, 3.2}, {0, 0.7, -0.5}, 0.9); }

TEST(RenderSizedLight, SpheresAndASunMatchTheReferenceHoweverTheyAreSampled) {
  const Scene scene = sizedStillLife();
  const Camera camera = sizedStillLifeCamera();
  const auto reference = measured(oracle::renderReference(scene, camera, 32, 24, 512));
  const Estimator cone{LightSampling::Mis, SphereLightSampling::Cone, SamplerKind::Sobol};
  const Estimator area{LightSampling::Mis, SphereLightSampling::Area, SamplerKind::Sobol};
  for (const Estimator& estimator : {cone, area}) {
    EstimatorSettings settings = estimator.settings();
    settings.maxDepth = kUnlimitedDepth;
    const Image image = renderImage(scene, camera, 32, 24, 512, {.estimator = settings});
    EXPECT_TRUE(sameImage(measured(image), reference, {.powerFloor = 0.02}));
  }
}

TEST(RenderSizedLight, ManySpheresChosenByTheLightTreeMatchTheReference) {
  Scene scene = lambertFloor(glm::vec3(0.7f), 3);
  addPrimitive(scene, quad({-2, 0, -1.8}, {4, 0, 0}, {0, 1.6, -0.8}, addMaterial(scene, metal(glm::vec3(0.9f), 0.3f))));
  std::mt19937 generator(40);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 40; ++i) {
    const glm::dvec3 position(4 * unit(generator) - 2, 1.5 * unit(generator), 3 * unit(generator) - 1.5);
    scene.lights.push_back(sphereLight(position, 0.02 + 0.1 * unit(generator), 5 * unit(generator)));
  }
  ASSERT_TRUE(sceneFeatures(scene).has(Feature::kHasLightTree));
  const Camera camera = sizedStillLifeCamera();
  const Image image = renderImage(scene, camera, 24, 18, 512, {.estimator = {.filter = PixelFilter::Box}});
  EXPECT_TRUE(
      sameImage(measured(image), measured(oracle::renderReference(scene, camera, 24, 18, 512)), {.powerFloor = 0.05}));
}

TEST(RenderSizedLight, SpecializedKernelsGiveTheImageOfThoseWithAllFeatures) {
  const Scene scene = sizedStillLife();
  const Camera camera = sizedStillLifeCamera();
  RenderOptions options;
  const Image specialized = renderImage(scene, camera, 24, 18, 16, options);
  options.execution.specialize = false;
  EXPECT_TRUE(bitIdentical(specialized, renderImage(scene, camera, 24, 18, 16, options)));
}

TEST(RenderSizedLight, TheCameraSeesASphereAsABlackSurfaceThatShines) {
  Scene scene;
  scene.lights = {sphereLight({0, 0, -5}, 1, 7)};
  const Image image = renderImage(scene, lookAt({0, 0, 0}, {0, 0, -1}, 0.02), 4, 4, 16);
  for (const float value : plane(image, "R")) EXPECT_NEAR(value, 7, 7e-6);
  for (const float value : plane(image, "A")) EXPECT_EQ(value, 1);
  for (const float value : plane(image, "albedo.R")) EXPECT_EQ(value, 0);
  for (const float value : plane(image, "normal.Z")) EXPECT_NEAR(value, 1, 2e-2);
  for (const float value : plane(image, "depth.Z")) EXPECT_NEAR(value, 4, 1e-2);
}

TEST(RenderSizedLight, ASceneOfASphereAloneHasItsShadow) {
  // A sphere light in front of another one, and nothing else: the nearer one hides the farther.
  Scene scene;
  scene.lights = {sphereLight({0, 0, -8}, 3, 5), sphereLight({0, 0, -4}, 0.5, 2)};
  const Image image = renderImage(scene, lookAt({0, 0, 0}, {0, 0, -1}, 0.02), 4, 4, 16);
  for (const float value : plane(image, "R")) EXPECT_NEAR(value, 2, 2e-6);
}

} // namespace
} // namespace isophote
