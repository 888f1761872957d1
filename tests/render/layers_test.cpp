// Layers over the base, rendered: against the reference tracer, and specialised kernels against the complete one.
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "support/gpu_device.hpp"
#include "support/render.hpp"
#include "support/scenes.hpp"

namespace isophote {
namespace {

using namespace isophote::test;

// A ball of each kind on a floor, under a small bright panel and a dim sky.
Scene ballsOf(const std::vector<Material>& materials) {
  Scene scene = lambertFloor(glm::vec3(0.5f), 4);
  for (size_t i = 0; i < materials.size(); ++i) {
    Primitive ball = sphere(0.5, 16, true, false, addMaterial(scene, materials[i]));
    addPrimitive(scene, ball,
                 glm::translate(glm::dmat4(1), {1.1 * (double(i) - 0.5 * double(materials.size() - 1)), 0.5, 0}));
  }
  const uint32_t panel = addMaterial(scene, emitter({6, 5, 4}));
  addPrimitive(scene, quad({-1, 2.5, 1}, {2, 0, 0}, {0, 0, 1}, panel));
  scene.environment = constantEnvironment({0.3f, 0.4f, 0.5f});
  return scene;
}

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

Camera ballsCamera() { return lookAt({0, 1.2, 4}, {0, 0.5, 0}, 0.6); }

TEST(RenderLayers, ClearcoatAndSheenMatchTheReference) {
  const Scene scene = layeredBalls();
  const auto reference = oracle::renderReference(scene, ballsCamera(), 36, 20, 512, {.seed = 4});
  const Image image = renderImage(scene, ballsCamera(), 36, 20, 512);
  EXPECT_TRUE(sameImage(measured(image), measured(reference), {.absoluteTolerance = 4e-3, .powerFloor = 0.015}));
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
