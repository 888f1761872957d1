// Instancing, cameras and glossy spheres against the reference and against flattened copies.
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "support/render.hpp"
#include "support/scenes.hpp"

namespace isophote {
namespace {

using namespace isophote::test;

TEST(RenderInstances, Test56InstancesAndFlattenedCopiesAreTheSameImage) {
  const Scene scene = instanceGrid();
  const Camera camera = instanceGridCamera();
  const auto reference = oracle::renderReference(scene, camera, 32, 24, 1024, {.seed = 56});
  const Image instanced = renderImage(scene, camera, 32, 24, 1024);
  RenderOptions other;
  other.estimator.seed = 57;
  const Image copies = renderImage(flattened(scene), camera, 32, 24, 1024, other);
  EXPECT_TRUE(sameImage(measured(instanced), measured(reference), {.powerFloor = 0.02}));
  EXPECT_TRUE(sameImage(measured(copies), measured(reference), {.powerFloor = 0.02}));
  EXPECT_TRUE(sameImage(measured(copies), measured(instanced), {.powerFloor = 0.02}));
}

/// The normal-mapped and smooth parts of a scene under one-sided light: mirroring must turn their normals as well.
Scene mirroredNormals() {
  Scene scene;
  Environment sky = oneTexelEnvironment(8, 4, 6, 1, {9, 8, 7});
  for (glm::vec3& pixel : sky.pixels) pixel += glm::vec3(0.3f);
  scene.environment = sky;
  Material embossed = dielectric({0.7f, 0.6f, 0.5f}, 0.5f);
  embossed.normalTexture = useTexture(
      addTexture(scene, 2, 1, {{210, 128, 225, 255}, {128, 190, 235, 255}}, Filter::Nearest, Wrap::ClampToEdge));
  Mesh mesh;
  mesh.primitives.push_back(facingQuad(0.8, 0.8, addMaterial(scene, embossed)));
  Primitive ball = sphere(0.5, 8, true, false, addMaterial(scene, lambert({0.3f, 0.6f, 0.9f})));
  for (glm::vec3& position : ball.positions) position += glm::vec3(0.2f, 1.4f, 0);
  mesh.primitives.push_back(ball);
  scene.meshes.push_back(mesh);
  const glm::dmat4 one(1);
  for (const glm::dmat4& place :
       {glm::translate(one, {-2.2, 0, 0}), glm::scale(one, glm::dvec3(-1, 1, 1)),
        glm::scale(glm::rotate(glm::translate(one, {2.2, 0, 0}), 0.3, glm::dvec3(0, 1, 0)), glm::dvec3(1, -1, 1))})
    scene.instances.push_back({.mesh = 0, .worldFromObject = place, .name = {}});
  return scene;
}

TEST(RenderInstances, MirroredInstancesTurnTheirNormalMapsAndSmoothNormals) {
  const Scene scene = mirroredNormals();
  const Camera camera = lookAt({0, 0.4, 7}, {0, 0.2, 0}, 0.9);
  const auto reference = oracle::renderReference(scene, camera, 36, 28, 1024, {.seed = 3});
  EXPECT_TRUE(sameImage(measured(renderImage(scene, camera, 36, 28, 768)), measured(reference), {.powerFloor = 0.01}));
  EXPECT_TRUE(sameImage(measured(renderImage(flattened(scene), camera, 36, 28, 768)), measured(reference),
                        {.powerFloor = 0.01}));
}

TEST(RenderCameras, OrthographicAndPerspectiveViewsMatchTheReference) {
  const Scene scene = cornellBox();
  Camera tilted = lookAt({0.4, 0.45, -0.5}, {0.2, 0.05, 0.3}, 0.6); // neither view sees the lamp
  tilted.aspectRatio = 1.5;                                         // the image decides: pixels stay square
  for (const Camera& camera : {tilted, orthographicLookAt({0.278, 0.25, -0.8}, {0.278, 0.23, 0}, 0.3, 0.2)}) {
    const auto reference = oracle::renderReference(scene, camera, 24, 24, 1024, {.seed = 12});
    EXPECT_TRUE(
        sameImage(measured(renderImage(scene, camera, 24, 24, 512)), measured(reference), {.powerFloor = 0.015}));
  }
}

TEST(RenderMaterials, MetalAndPlasticSpheresMatchTheReference) {
  const Scene scene = materialSpheres();
  const Camera camera = materialSpheresCamera();
  const auto reference = oracle::renderReference(scene, camera, 48, 24, 1024, {.seed = 20});
  for (const auto mode : {LightSampling::Mis, LightSampling::BsdfOnly}) {
    RenderOptions options;
    options.estimator.lightSampling = mode;
    // The engine reads albedo from a 32 x 32 table: up to 1e-3 from the reference's quadrature (tests/glsl).
    EXPECT_TRUE(sameImage(measured(renderImage(scene, camera, 48, 24, 512, options)), measured(reference),
                          {.absoluteTolerance = 1e-3, .powerFloor = 0.005}));
  }
}

TEST(RenderMaterials, MirrorsShowTheEmittersTheyFace) {
  // Reflectance 0.9, 0.5, 0.2 at every angle: baseColor is f0, and at normal incidence Schlick adds nothing.
  Scene scene;
  addPrimitive(scene, facingQuad(1, 1, addMaterial(scene, metal({0.9f, 0.5f, 0.2f}, 0))));
  addPrimitive(scene, quad({-2, -2, 3}, {0, 4, 0}, {4, 0, 0}, addMaterial(scene, emitter({2, 2, 2}))));
  for (const auto mode : {LightSampling::Mis, LightSampling::LightsOnly, LightSampling::BsdfOnly}) {
    RenderOptions options;
    options.estimator.lightSampling = mode;
    const Image image = renderImage(scene, orthographicLookAt({0, 0, 1}, {}, 0.5, 0.5), 4, 4, 16, options);
    for (const float value : plane(image, "R")) ASSERT_NEAR(value, 1.8, 1e-5);
    for (const float value : plane(image, "G")) ASSERT_NEAR(value, 1.0, 1e-5);
    for (const float value : plane(image, "B")) ASSERT_NEAR(value, 0.4, 1e-5);
  }
}

} // namespace
} // namespace isophote
