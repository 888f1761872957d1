// What fills bodies, rendered against the reference tracer: absorption, scattering, nested bodies.
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "support/gpu_device.hpp"
#include "support/render.hpp"
#include "support/scenes.hpp"

namespace isophote {
namespace {

using namespace isophote::test;

Material filled(Material material, glm::vec3 color, float distance, glm::vec3 multiscatterColor = glm::vec3(0)) {
  material.volume.thickness = 1;
  material.volume.attenuationColor = color;
  material.volume.attenuationDistance = distance;
  material.volume.multiscatterColor = multiscatterColor;
  return material;
}

void expectReference(const Scene& scene, double powerFloor) {
  const auto reference = oracle::renderReference(scene, ballsCamera(), 36, 20, 512, {.seed = 4});
  const Image image = renderImage(scene, ballsCamera(), 36, 20, 512);
  EXPECT_TRUE(sameImage(measured(image), measured(reference), {.absoluteTolerance = 4e-3, .powerFloor = powerFloor}));
}

// Smooth green glass, rough red glass of another index, and a mist behind a boundary that does nothing.
TEST(RenderMediaReference, AbsorbingBodiesMatch) {
  Material mist = filled(glass(0, 1), {0.4f, 0.6f, 0.9f}, 0.5f);
  expectReference(
      ballsOf({filled(glass(0), {0.3f, 0.8f, 0.4f}, 0.5f), filled(glass(0.4f, 1.33f), {0.9f, 0.3f, 0.2f}, 0.5f), mist}),
      0.04);
}

// Milk behind a smooth boundary, jade behind a rough one, smoke in the sun behind one that does nothing.
TEST(RenderMediaReference, ScatteringBodiesMatch) {
  Material milk = filled(glass(0, 1.33f), {0.3f, 0.25f, 0.2f}, 0.5f, {0.95f, 0.9f, 0.85f});
  milk.volume.scatterAnisotropy = 0.6f;
  const Material jade = filled(glass(0.5f, 1.6f), {0.2f, 0.5f, 0.3f}, 0.4f, {0.5f, 0.9f, 0.6f});
  Material smoke = filled(glass(0, 1), {0.1f, 0.2f, 0.4f}, 0.5f, {0.9f, 0.8f, 0.6f});
  smoke.volume.scatterAnisotropy = 0.7f;
  Scene scene = ballsOf({milk, jade, smoke});
  PunctualLight sun; // which reaches the smoke alone
  sun.kind = LightKind::Directional;
  sun.intensity = glm::vec3(2);
  sun.direction = glm::normalize(glm::vec3(1, -1, 2));
  scene.lights.push_back(sun);
  expectReference(scene, 0.04);
}

// Wax that light enters diffusely: absorbing, scattering, and half of it glass.
TEST(RenderMediaReference, BodiesBehindDiffuseBoundariesMatch) {
  Material amber = filled(dielectric({0.8f, 0.7f, 0.6f}, 0.5f), {0.8f, 0.5f, 0.2f}, 0.5f);
  amber.diffuseTransmission.factor = 0.7f;
  amber.diffuseTransmission.color = {0.9f, 0.8f, 0.7f};
  Material wax = amber;
  wax.volume.multiscatterColor = {0.9f, 0.7f, 0.5f};
  Material half = wax;
  half.transmission.factor = 0.5f;
  expectReference(ballsOf({amber, wax, half}), 0.04);
}

// Water reaching into the wall of its vessel, with a plastic ball and a bubble in it.
TEST(RenderMediaReference, NestedBodiesMatch) {
  Material vessel = filled(glass(0), {0.8f, 0.9f, 0.8f}, 0.5f);
  vessel.volume.priority = 2;
  Scene scene = ballsOf({dielectric({0.8f, 0.2f, 0.2f}, 0.3f)});
  Material water = filled(glass(0, 1.33f), {0.5f, 0.7f, 0.9f}, 1);
  water.volume.priority = 1;
  Material bubble = filled(glass(0, 1), glm::vec3(1), 0);
  bubble.volume.priority = 3;
  const uint32_t wall = addMaterial(scene, vessel), inside = addMaterial(scene, water);
  addPrimitive(scene, box({-1.0, 0.02, -0.8}, {-0.8, 1.1, 0.8}, false, wall));
  addPrimitive(scene, box({0.8, 0.02, -0.8}, {1.0, 1.1, 0.8}, false, wall));
  addPrimitive(scene, box({-0.9, 0.01, -0.7}, {0.9, 1.03, 0.7}, false, inside));
  addPrimitive(scene, sphere(0.2, 16, true, false, addMaterial(scene, bubble)),
               glm::translate(glm::dmat4(1), {0.6, 0.5, 0.5}));
  expectReference(scene, 0.04);
}

} // namespace
} // namespace isophote
