// Environment maps: irradiance of single texels, pixel filters, and whole images.
#include <cmath>

#include <gtest/gtest.h>

#include "oracle/environment_map.hpp"
#include "support/render.hpp"
#include "support/scenes.hpp"

namespace isophote {
namespace {

using namespace isophote::test;

constexpr double kPi = 3.14159265358979323846;

struct TexelCase {
  uint32_t x, y;
  double rotation;
  glm::dvec3 normal;
};

/// Irradiance on `normal` by the midpoint rule over the sphere; the bilinear radiance is smooth but for its kinks.
double irradiance(const Environment& environment, glm::dvec3 normal) {
  const oracle::EnvironmentMap map(environment);
  constexpr int kRows = 1600, kColumns = 3200;
  double sum = 0;
  for (int row = 0; row < kRows; ++row) {
    const double theta = kPi * (row + 0.5) / kRows;
    for (int column = 0; column < kColumns; ++column) {
      const double phi = 2 * kPi * (column + 0.5) / kColumns;
      const glm::dvec3 d(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
      const double cosine = glm::dot(d, normal);
      if (cosine > 0) sum += map.radiance(d).x * cosine * std::sin(theta);
    }
  }
  return sum * (kPi / kRows) * (2 * kPi / kColumns);
}

TEST(RenderEnvironment, TexelIrradianceHasItsClosedFormUnderTheIntegrator) {
  // On +y, away from poles: L dphi times the integral of the tent over sin t cos t; 2e-5 of the midpoint rule.
  const double dTheta = kPi / 8, center = 2.5 * dTheta, dPhi = 2 * kPi / 16;
  const double tent = std::sin(2 * center) / 2 * std::pow(std::sin(dTheta), 2) / dTheta;
  EXPECT_NEAR(irradiance(oneTexelEnvironment(16, 8, 3, 2, glm::vec3(5)), {0, 1, 0}), 5 * dPhi * tent, 1e-4);
}

std::string lightSamplingName(const testing::TestParamInfo<LightSampling>& info) {
  const char* const names[] = {"Mis", "LightsOnly", "BsdfOnly"};
  return names[static_cast<size_t>(info.param)];
}

// The sensor, one face, under the environment: expects its radiance to `powerFloor`.
void expectIrradiance(const Environment& environment, const glm::dvec3& normal, LightSampling lightSampling,
                      uint32_t samples, double powerFloor) {
  Scene scene;
  scene.environment = environment;
  // Seen along its normal from in front of nothing.
  const glm::dvec3 u =
      glm::normalize(glm::cross(std::abs(normal.y) > 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0), normal));
  const glm::dvec3 v = glm::cross(normal, u);
  addPrimitive(scene, quad(-u - v, 2.0 * u, 2.0 * v, addMaterial(scene, lambert(glm::vec3(1)))));
  const Camera camera = orthographicLookAt(normal, glm::dvec3(0), 0.5, 0.5);
  const EstimatorSettings estimator{.filter = PixelFilter::Box, .lightSampling = lightSampling, .seed = 35};
  const Image image = renderImage(scene, camera, 8, 8, samples, {.estimator = estimator});
  EXPECT_TRUE(pixelMeanIs(image, "R", irradiance(environment, normal) / kPi, powerFloor));
}

class EnvironmentTexels : public testing::TestWithParam<LightSampling> {};

TEST_P(EnvironmentTexels, Test35OneTexelGivesItsIrradiance) {
  const glm::dvec3 up(0, 1, 0), down(0, -1, 0), aside = glm::normalize(glm::dvec3(0.3, 0.2, -1));
  for (const TexelCase& texel : {TexelCase{3, 2, 0.0, up}, TexelCase{0, 0, 0.0, up}, TexelCase{9, 7, 0.0, down},
                                 TexelCase{8, 3, 0.0, aside}, TexelCase{12, 4, kPi / 2, aside}}) {
    Environment environment = oneTexelEnvironment(16, 8, texel.x, texel.y, {4, 2, 1});
    environment.rotation = texel.rotation;
    environment.intensity = 2;
    SCOPED_TRACE(testing::Message() << "texel " << texel.x << "," << texel.y);
    const bool blind = GetParam() == LightSampling::BsdfOnly; // finds the texel rarely
    expectIrradiance(environment, texel.normal, GetParam(), blind ? 16384 : 2048, blind ? 0.05 : 0.003);
  }
}

// A texel wide enough for BSDF samples to find it, to 0.3%.
TEST(RenderEnvironment, Test35AWideTexelGivesItsIrradianceByBsdfSamples) {
  const Environment environment = oneTexelEnvironment(4, 2, 1, 0, {4, 2, 1});
  expectIrradiance(environment, {0, 1, 0}, LightSampling::BsdfOnly, 2048, 0.003);
}

INSTANTIATE_TEST_SUITE_P(RenderEnvironment, EnvironmentTexels,
                         testing::Values(LightSampling::Mis, LightSampling::LightsOnly, LightSampling::BsdfOnly),
                         lightSamplingName);

TEST(RenderEnvironment, Test37EveryFilterKeepsAConstantToTheBorders) {
  Scene scene;
  scene.environment = constantEnvironment({0.25f, 1, 3});
  for (const auto filter : {PixelFilter::Box, PixelFilter::Gaussian, PixelFilter::BlackmanHarris}) {
    const Image image = renderImage(scene, lookAt({}, {0, 0, -1}, 0.8), 17, 9, 16, {.estimator = {.filter = filter}});
    for (const float value : plane(image, "R")) ASSERT_NEAR(value, 0.25, 0.25e-6);
    for (const float value : plane(image, "G")) ASSERT_NEAR(value, 1, 1e-6);
    for (const float value : plane(image, "B")) ASSERT_NEAR(value, 3, 3e-6);
    for (const float value : plane(image, "A")) ASSERT_EQ(value, 0);
  }
}

TEST(RenderEnvironment, WhiteLambertSphereIsInvisibleInAWhiteFurnace) {
  Scene scene;
  scene.environment = constantEnvironment(glm::vec3(1));
  addPrimitive(scene, sphere(1, 10, false, false, addMaterial(scene, lambert(glm::vec3(1)))));
  for (const auto mode : {LightSampling::Mis, LightSampling::LightsOnly, LightSampling::BsdfOnly}) {
    const Image image = renderImage(scene, lookAt({0, 0, 4}, {}, 0.6), 16, 16, 512,
                                    {.estimator = {.filter = PixelFilter::Box, .lightSampling = mode}});
    EXPECT_TRUE(pixelMeanIs(image, "G", 1, 0.006));
  }
}

TEST(RenderEnvironment, SkyWithSunSeenDirectlyAndByAFloorMatchesTheReference) {
  Scene scene = lambertFloor({0.8f, 0.7f, 0.6f}, 3);
  addPrimitive(scene, box({-0.5, 0, -0.5}, {0.5, 1, 0.5}, false, addMaterial(scene, lambert(glm::vec3(0.5f)))));
  Environment sky = oneTexelEnvironment(32, 16, 21, 4, {60, 50, 40});
  for (uint32_t i = 0; i < sky.pixels.size(); ++i) {
    const auto height = static_cast<float>(i / sky.width) / 16;
    sky.pixels[i] += glm::vec3(0.3f + 0.1f * height, 0.5f, 0.9f - 0.5f * height);
  }
  sky.rotation = -0.7;
  scene.environment = sky;
  const Camera camera = lookAt({1, 2, 4}, {0, 0.6, 0}, 0.9);
  const Image image = renderImage(scene, camera, 32, 24, 512);
  const auto reference = oracle::renderReference(scene, camera, 32, 24, 1024);
  EXPECT_TRUE(sameImage(measured(image), measured(reference), {.powerFloor = 0.01}));
}

} // namespace
} // namespace isophote
