// Layers over the base, rendered: against the reference tracer, and specialised kernels against the complete one.
#include <gtest/gtest.h>

#include "support/gpu_device.hpp"
#include "support/render.hpp"
#include "support/scenes.hpp"

namespace isophote {
namespace {

using namespace isophote::test;

Scene layeredBalls() {
  Material coated = dielectric({0.7f, 0.1f, 0.1f}, 0.5f);
  coated.clearcoat.factor = 1;
  coated.clearcoat.roughness = 0.3f;
  Material flakes = metal({0.3f, 0.5f, 0.8f}, 0.6f);
  flakes.clearcoat.factor = 0.8f;
  flakes.clearcoat.roughness = 0.2f;
  Material velvet = dielectric({0.1f, 0.1f, 0.4f}, 0.8f);
  velvet.sheen.color = {0.9f, 0.7f, 0.5f};
  velvet.sheen.roughness = 0.5f;
  return ballsOf({coated, flakes, velvet});
}

TEST(RenderLayers, ClearcoatAndSheenMatchTheReference) {
  const Scene scene = layeredBalls();
  const auto reference = oracle::renderReference(scene, ballsCamera(), 36, 20, 512, {.seed = 4});
  const Image image = renderImage(scene, ballsCamera(), 36, 20, 512);
  EXPECT_TRUE(sameImage(measured(image), measured(reference), {.absoluteTolerance = 4e-3, .powerFloor = 0.015}));
}

// Each compared alone: `scene` at 512 samples a pixel on both sides.
void expectReference(const Scene& scene, double powerFloor) {
  const auto reference = oracle::renderReference(scene, ballsCamera(), 36, 20, 512, {.seed = 4});
  const Image image = renderImage(scene, ballsCamera(), 36, 20, 512);
  EXPECT_TRUE(sameImage(measured(image), measured(reference), {.absoluteTolerance = 4e-3, .powerFloor = powerFloor}));
}

// Brushed metals, the second askew, the third by a texture of direction and strength.
TEST(RenderLayers, AnisotropyMatchesTheReference) {
  Material along = metal({0.8f, 0.7f, 0.6f}, 0.4f);
  along.anisotropy.strength = 0.8f;
  Material across = metal({0.6f, 0.7f, 0.8f}, 0.3f);
  across.anisotropy.strength = 0.7f;
  across.anisotropy.rotation = 0.8f;
  Material brushed = along;
  Scene scene = ballsOf({along, across, brushed});
  scene.materials[3].anisotropy.texture = useTexture(
      addTexture(scene, 2, 2, {{255, 128, 255, 255}, {128, 255, 180, 255}, {218, 218, 100, 255}, {37, 218, 255, 255}},
                 Filter::Nearest));
  expectReference(scene, 0.02);
}

// Soap, an annealed metal, and a film whose factor and thickness a texture gives.
TEST(RenderLayers, IridescenceMatchesTheReference) {
  Material soap = dielectric({0.3f, 0.3f, 0.3f}, 0.3f);
  soap.iridescence = {.factor = 1, .ior = 1.33f, .thicknessMaximum = 450};
  Material annealed = metal({0.6f, 0.5f, 0.4f}, 0.3f);
  annealed.iridescence = {.factor = 0.8f, .ior = 1.8f, .thicknessMaximum = 250};
  Material pattern = annealed;
  pattern.iridescence = {.factor = 1, .ior = 1.8f, .thicknessMinimum = 150, .thicknessMaximum = 600};
  Scene scene = ballsOf({soap, annealed, pattern});
  const uint32_t texture = addTexture(scene, 2, 1, {{255, 40, 0, 255}, {120, 220, 0, 255}}, Filter::Nearest);
  scene.materials[3].iridescence.texture = scene.materials[3].iridescence.thicknessTexture = useTexture(texture);
  expectReference(scene, 0.02);
}

// Gold, aluminium, and half a metal over plastic, by their indices at red, green and blue.
TEST(RenderLayers, ConductorsMatchTheReference) {
  Material gold = metal(glm::vec3(1), 0.3f);
  gold.conductor = {true, {0.143f, 0.374f, 1.442f}, {3.983f, 2.387f, 1.603f}};
  Material aluminium = metal(glm::vec3(1), 0.5f);
  aluminium.conductor = {true, {1.346f, 0.965f, 0.617f}, {7.475f, 6.400f, 5.303f}};
  Material flakes = gold;
  flakes.metallic = 0.5f;
  flakes.baseColor = {0.2f, 0.3f, 0.6f, 1};
  expectReference(ballsOf({gold, aluminium, flakes}), 0.02);
}

// A coat with a normal map of its own, on a base that has none.
TEST(RenderLayers, TheClearcoatsNormalMapMatchesTheReference) {
  Material coated = dielectric({0.5f, 0.1f, 0.1f}, 0.7f);
  coated.clearcoat.factor = 1;
  coated.clearcoat.roughness = 0.25f;
  Scene scene = ballsOf({coated, coated});
  TextureRef map = useTexture(
      addTexture(scene, 2, 2, {{170, 128, 245, 255}, {128, 170, 245, 255}, {128, 86, 245, 255}, {86, 128, 245, 255}},
                 Filter::Nearest));
  map.scale = 1;
  scene.materials[2].clearcoat.normalTexture = map;
  expectReference(scene, 0.02);
}

TEST(RenderLayers, SpecialisedKernelsRenderTheSame) {
  if (!gpuDevice().isCpu()) GTEST_SKIP() << "bit-identity of specialised kernels is promised for CPU devices only";
  const Scene scene = layeredBalls();
  RenderOptions complete;
  complete.execution.specialize = false;
  EXPECT_TRUE(bitIdentical(renderImage(scene, ballsCamera(), 24, 16, 8),
                           renderImage(scene, ballsCamera(), 24, 16, 8, complete)));
}

} // namespace
} // namespace isophote
