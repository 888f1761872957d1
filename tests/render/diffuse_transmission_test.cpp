// Diffuse transmission in whole paths: sheets and slabs with closed forms, furnaces, and the double-precision tracer.
#include <cmath>
#include <numbers>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "support/gpu_device.hpp"
#include "support/render.hpp"
#include "support/scenes.hpp"

namespace isophote {
namespace {

using namespace isophote::test;

constexpr uint32_t kSize = 8;

Material leaf(Material material, float factor, glm::vec3 color) {
  material.diffuseTransmission.factor = factor;
  material.diffuseTransmission.color = color;
  return material;
}

const glm::vec3 kFront(0.7f, 0.5f, 0.3f);
const glm::vec3 kBehind(0.2f, 0.8f, 0.4f);

class DiffuseSheet : public testing::TestWithParam<LightSampling> {};

// A chamber whose five black walls shine with radiance 1, one of them of so many quads that lights are chosen by the
// light tree; the sixth is the sheet. Outside, which is dark, it shows factor times its color behind; inside (1 -
// factor) of its base color.
TEST_P(DiffuseSheet, BetweenAFurnaceAndTheDarkPassesItsFactor) {
  Scene scene;
  const uint32_t wall = addMaterial(scene, emitter(glm::vec3(1)));
  for (int i = 0; i < 16; ++i)
    addPrimitive(scene, quad({-1 + 0.5 * (i % 4), -1 + 0.5 * (i / 4), -2}, {0.5, 0, 0}, {0, 0.5, 0}, wall));
  addPrimitive(scene, quad({-1, -1, -2}, {0, 2, 0}, {0, 0, 2}, wall));
  addPrimitive(scene, quad({1, -1, -2}, {0, 0, 2}, {0, 2, 0}, wall));
  addPrimitive(scene, quad({-1, -1, -2}, {0, 0, 2}, {2, 0, 0}, wall));
  addPrimitive(scene, quad({-1, 1, -2}, {2, 0, 0}, {0, 0, 2}, wall));
  constexpr float kFactor = 0.6f;
  addPrimitive(scene,
               quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, addMaterial(scene, leaf(lambert(kFront), kFactor, kBehind))));
  const Camera outside = orthographicLookAt({0.03, 0.02, 1}, {0.03, 0.02, 0}, 0.5, 0.5);
  const Camera inside = orthographicLookAt({0.03, 0.02, -1}, {0.03, 0.02, 0}, 0.5, 0.5);
  const RenderOptions options{.estimator = {.filter = PixelFilter::Box, .lightSampling = GetParam(), .seed = 2}};
  const char* channels[] = {"R", "G", "B"};
  for (int c = 0; c < 3; ++c) {
    const double behind = double(kFactor * kBehind[c]), front = double((1 - kFactor) * kFront[c]);
    EXPECT_TRUE(pixelMeanIs(renderImage(scene, outside, kSize, kSize, 512, options), channels[c], behind, 0.02)) << c;
    EXPECT_TRUE(pixelMeanIs(renderImage(scene, inside, kSize, kSize, 512, options), channels[c], front, 0.02)) << c;
  }
}

std::string lightSamplingName(const testing::TestParamInfo<LightSampling>& info) {
  const char* const names[] = {"Mis", "LightsOnly", "BsdfOnly"};
  return names[static_cast<size_t>(info.param)];
}

INSTANTIATE_TEST_SUITE_P(RenderDiffuseTransmission, DiffuseSheet,
                         testing::Values(LightSampling::Mis, LightSampling::LightsOnly, LightSampling::BsdfOnly),
                         lightSamplingName);

// A directional light behind: factor color / pi times irradiance, without noise.
TEST(RenderDiffuseTransmission, ALightBehindTheSheetIsSampled) {
  Scene scene;
  addPrimitive(scene, facingQuad(2, 2, addMaterial(scene, leaf(lambert(kFront), 0.5f, kBehind))));
  PunctualLight sun;
  sun.kind = LightKind::Directional;
  sun.intensity = glm::vec3(float(std::numbers::pi));
  sun.direction = glm::normalize(glm::vec3(1, 0, 2)); // from -z
  scene.lights.push_back(sun);
  const Camera camera = orthographicLookAt({0, 0, 1}, {0, 0, 0}, 0.5, 0.5);
  const Image image = renderImage(scene, camera, kSize, kSize, 2);
  const char* channels[] = {"R", "G", "B"};
  for (int c = 0; c < 3; ++c) {
    const double expected = 0.5 * double(kBehind[c]) * 2 / std::sqrt(5.0);
    for (const float value : plane(image, channels[c])) ASSERT_NEAR(double(value), expected, 1e-5);
  }
}

// 2 E_3(x), what of diffuse light crosses a slab of optical depth x: the integral over mu of 2 mu exp(-x / mu).
double diffuseTransmittance(double x) {
  double sum = 0;
  constexpr int kSteps = 20000;
  for (int i = 0; i < kSteps; ++i) {
    const double mu = (i + 0.5) / kSteps;
    sum += 2 * mu * std::exp(-x / mu) / kSteps;
  }
  return sum;
}

// A slab without end of an absorbing medium behind diffuse boundaries, over an emitter of radiance 1. Light that meets
// the lower boundary from inside finds u = t c + (1 - t) b T v, the upper one v = (1 - t) b T u; seen is t c T u.
TEST(RenderDiffuseTransmission, ASlabOfAMediumIsTheSeriesOfItsDiffuseBoundaries) {
  constexpr double kHalf = 1e3;
  constexpr float kFactor = 0.6f;
  Scene scene;
  addPrimitive(scene, quad({-kHalf, 0, kHalf}, {2 * kHalf, 0, 0}, {0, 0, -2 * kHalf},
                           addMaterial(scene, emitter(glm::vec3(1)))));
  Material wax = leaf(lambert(glm::vec3(0.9f)), kFactor, glm::vec3(0.95f));
  wax.volume = {.thickness = 1, .attenuationColor = {0.9f, 0.5f, 0.2f}, .attenuationDistance = 1};
  addPrimitive(scene, box({-kHalf, 1, -kHalf}, {kHalf, 2, kHalf}, false, addMaterial(scene, wax)));
  const Camera camera = orthographicLookAt({0.5, 4, 0}, {0, 2, 0}, 0.5, 0.5);
  const Image image =
      renderImage(scene, camera, kSize, kSize, 4096,
                  {.estimator = {.filter = PixelFilter::Box, .lightSampling = LightSampling::BsdfOnly, .seed = 3}});
  const char* channels[] = {"R", "G", "B"};
  for (int c = 0; c < 3; ++c) {
    const double T = diffuseTransmittance(-std::log(double(wax.volume.attenuationColor[c])));
    const double crossing = double(kFactor) * 0.95, returning = (1 - double(kFactor)) * 0.9 * T;
    const double expected = crossing * T * crossing / (1 - returning * returning);
    EXPECT_TRUE(pixelMeanIs(image, channels[c], expected, 0.02)) << c;
  }
}

Camera furnaceCamera() { return orthographicLookAt({0.03, 0.02, 3}, {0.03, 0.02, 0}, 0.7, 0.7); }

// White paper, milk behind a diffuse boundary, and a body of which half is glass, each in a white world.
TEST(RenderDiffuseTransmission, LosslessBodiesAreInvisibleInAFurnace) {
  const Material paper = leaf(dielectric(glm::vec3(1), 0.5f), 0.7f, glm::vec3(1));
  Material milk = paper;
  milk.volume = {.thickness = 1,
                 .attenuationColor = {0.4f, 0.3f, 0.2f},
                 .attenuationDistance = 1,
                 .multiscatterColor = glm::vec3(1)};
  Material half = milk;
  half.transmission.factor = 0.5f;
  Material coated = milk;
  coated.roughness = 0;
  for (const Material& material : {paper, milk, half, coated}) {
    Scene scene;
    scene.environment = constantEnvironment(glm::vec3(1));
    addPrimitive(scene, sphere(1, 8, false, false, addMaterial(scene, material)));
    const Image image =
        renderImage(scene, furnaceCamera(), kSize, kSize, 512,
                    {.estimator = {.filter = PixelFilter::Box, .lightSampling = LightSampling::BsdfOnly, .seed = 4}});
    EXPECT_TRUE(pixelMeanIs(image, "G", 1, 0.02));
  }
}

// Leaves, one of them coated and one with textures of factor and color, before and behind small lights.
Scene leaves() {
  Scene scene = lambertFloor(glm::vec3(0.5f), 4);
  Material plain = leaf(dielectric(kFront, 0.5f), 0.6f, kBehind);
  Material coated = plain;
  coated.clearcoat.factor = 1;
  coated.clearcoat.roughness = 0.4f;
  Material patterned = leaf(dielectric(kFront, 0.8f), 0.9f, glm::vec3(1));
  patterned.diffuseTransmission.texture = useTexture(
      addTexture(scene, 2, 2, {{0, 0, 0, 255}, {0, 0, 0, 60}, {0, 0, 0, 120}, {0, 0, 0, 200}}, Filter::Nearest));
  patterned.diffuseTransmission.colorTexture =
      useTexture(addTexture(scene, 2, 1, {{255, 120, 60, 255}, {60, 200, 255, 255}}, Filter::Nearest));
  const Material materials[] = {plain, coated, patterned};
  for (int i = 0; i < 3; ++i) {
    const glm::dmat4 place = glm::translate(glm::dmat4(1), {1.1 * (i - 1), 0.6, 0});
    addPrimitive(scene, facingQuad(0.5, 0.5, addMaterial(scene, materials[i])),
                 glm::rotate(place, 0.3 * (i - 1), glm::dvec3(0, 1, 0)));
  }
  const uint32_t panel = addMaterial(scene, emitter({6, 5, 4}));
  addPrimitive(scene, quad({-0.5, 0.5, -1.5}, {1, 0, 0}, {0, 1, 0}, panel));
  addPrimitive(scene, quad({-1, 2.5, 1}, {2, 0, 0}, {0, 0, 1}, panel));
  scene.environment = constantEnvironment({0.1f, 0.15f, 0.2f});
  return scene;
}

Camera leavesCamera() { return lookAt({0, 1.2, 4}, {0, 0.6, 0}, 0.55); }

TEST(RenderDiffuseTransmission, LeavesMatchTheReference) {
  const auto reference = oracle::renderReference(leaves(), leavesCamera(), 36, 18, 512, {.seed = 4});
  const Image image = renderImage(leaves(), leavesCamera(), 36, 18, 512);
  EXPECT_TRUE(sameImage(measured(image), measured(reference), {.absoluteTolerance = 4e-3, .powerFloor = 0.02}));
}

void expectSpecialisedKernelsRenderTheSame(const Scene& scene) {
  RenderOptions complete;
  complete.execution.specialize = false;
  EXPECT_TRUE(bitIdentical(renderImage(scene, leavesCamera(), 24, 16, 8),
                           renderImage(scene, leavesCamera(), 24, 16, 8, complete)));
}

TEST(RenderDiffuseTransmission, SpecialisedKernelsRenderTheSameSlow) {
  if (!gpuDevice().isCpu()) GTEST_SKIP() << "bit-identity of specialised kernels is promised for CPU devices only";
  expectSpecialisedKernelsRenderTheSame(leaves());
}

TEST(RenderDiffuseTransmission, SpecialisedKernelsWithoutFacetsRenderTheSameSlow) {
  if (!gpuDevice().isCpu()) GTEST_SKIP() << "bit-identity of specialised kernels is promised for CPU devices only";
  Scene lambertian = lambertFloor(glm::vec3(0.5f), 4);
  addPrimitive(lambertian, sphere(0.5, 12, true, false, addMaterial(lambertian, leaf(lambert(kFront), 0.6f, kBehind))),
               glm::translate(glm::dmat4(1), {0, 0.6, 0}));
  lambertian.environment = constantEnvironment({0.3f, 0.4f, 0.5f});
  expectSpecialisedKernelsRenderTheSame(lambertian);
}

} // namespace
} // namespace isophote
