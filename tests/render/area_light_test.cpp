// Irradiance from polygons against Lambert's formula.
#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "envelope/closed_forms.hpp"
#include "support/render.hpp"
#include "support/scenes.hpp"

namespace isophote {
namespace {

using namespace isophote::test;

/// Reflectance 1: radiance is irradiance / pi. 64 pixels of the same tiny view are the replicates.
Image renderSensor(const Scene& scene, glm::dvec3 point, LightSampling mode, uint32_t samples,
                   TriangleLightSampling triangles = TriangleLightSampling::Area) {
  EstimatorSettings estimator{.filter = PixelFilter::Box, .lightSampling = mode, .seed = 22};
  estimator.triangleLightSampling = triangles;
  return renderImage(scene, sensorAt(point), 8, 8, samples, {.estimator = estimator});
}

TEST(RenderAreaLight, Test22SquareGivesLambertsFormFactorCentredAndAtItsCorner) {
  const Scene scene = squareLightOverFloor(2);
  EXPECT_NEAR(polygonIrradiance({{-.5, 1, -.5}, {.5, 1, -.5}, {.5, 1, .5}, {-.5, 1, .5}}), 0.752275, 1e-6);
  for (const auto mode : {LightSampling::Mis, LightSampling::LightsOnly}) {
    EXPECT_TRUE(pixelMeanIs(renderSensor(scene, {0, 0, 0}, mode, 4096), "R", 2 * 0.2394564705));
    EXPECT_TRUE(pixelMeanIs(renderSensor(scene, {0.5, 0, 0.5}, mode, 8192), "R", 2 * 0.1385323412, 0.004));
  }
  EXPECT_TRUE(
      pixelMeanIs(renderSensor(scene, {0, 0, 0}, LightSampling::BsdfOnly, 16384), "R", 2 * 0.2394564705, 0.012));
}

TEST(RenderAreaLight, Test22SquareBySolidAngle) {
  const Scene scene = squareLightOverFloor(2);
  for (const auto mode : {LightSampling::Mis, LightSampling::LightsOnly}) {
    const auto render = [&](glm::dvec3 point) {
      return renderSensor(scene, point, mode, 2048, TriangleLightSampling::SolidAngle);
    };
    EXPECT_TRUE(pixelMeanIs(render({0, 0, 0}), "R", 2 * 0.2394564705));
    EXPECT_TRUE(pixelMeanIs(render({0.5, 0, 0.5}), "R", 2 * 0.1385323412, 0.004));
  }
}

TEST(RenderAreaLight, Test22RandomTrianglesGiveLambertsFormFactor) {
  std::mt19937_64 engine(22);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int i = 0; i < 5; ++i) {
    std::array<glm::vec3, 3> vertices;
    for (glm::vec3& vertex : vertices)
      vertex = {1.5 * uniform(engine), 1.2 + 0.6 * uniform(engine), 1.5 * uniform(engine)};
    // The front must face the floor: the origin lies on the side of the normal.
    if (glm::dot(glm::cross(vertices[1] - vertices[0], vertices[2] - vertices[0]), -vertices[0]) < 0)
      std::swap(vertices[1], vertices[2]);
    Scene scene = lambertFloor(glm::vec3(1), 2);
    Primitive light;
    light.positions = {vertices.begin(), vertices.end()};
    light.indices = {0, 1, 2};
    light.material = addMaterial(scene, emitter({3, 2, 1}));
    addPrimitive(scene, light);
    const double expected = polygonIrradiance({vertices[0], vertices[1], vertices[2]}) / kPi;
    for (const auto triangles : {TriangleLightSampling::Area, TriangleLightSampling::SolidAngle}) {
      const Image image = renderSensor(scene, {0, 0, 0}, LightSampling::Mis, 2048, triangles);
      SCOPED_TRACE(testing::Message() << i << ", sampling " << static_cast<uint32_t>(triangles));
      EXPECT_TRUE(pixelMeanIs(image, "R", 3 * expected, 0.006));
      EXPECT_TRUE(pixelMeanIs(image, "B", expected, 0.006));
    }
  }
}

// Lights in a coordinate plane have no rounding error to be offset by: shadow rays must not end on them by rounding.
TEST(RenderAreaLight, ALightInACoordinatePlaneDoesNotShadowItself) {
  Scene scene;
  addPrimitive(scene, quad({-2, 1, 2}, {0, 0, -4}, {4, 0, 0}, addMaterial(scene, lambert(glm::vec3(1)))));
  addPrimitive(scene, quad({-0.5, 0, 0.5}, {1, 0, 0}, {0, 0, -1}, addMaterial(scene, emitter(glm::vec3(2)))));
  const Camera camera = lookAt({0.9, 0.5, 0}, {0, 1, 0}, 1e-4);
  const Image image = renderImage(
      scene, camera, 8, 8, 4096,
      {.estimator = {.filter = PixelFilter::Box, .lightSampling = LightSampling::LightsOnly, .maxDepth = 1}});
  EXPECT_TRUE(pixelMeanIs(image, "R", 2 * 0.2394564705));
}

TEST(RenderAreaLight, BackOfASingleSidedLightIsDarkAndDoubleSidedLightsShineBothWays) {
  for (const bool doubleSided : {false, true}) {
    Scene scene = squareLightOverFloor(2);
    std::swap(scene.meshes[1].primitives[0].indices[1], scene.meshes[1].primitives[0].indices[2]);
    std::swap(scene.meshes[1].primitives[0].indices[4], scene.meshes[1].primitives[0].indices[5]);
    scene.materials[1].doubleSided = doubleSided;
    const Image image = renderSensor(scene, {0, 0, 0}, LightSampling::Mis, 4096);
    if (doubleSided) {
      EXPECT_TRUE(pixelMeanIs(image, "R", 2 * 0.2394564705));
    } else {
      for (const float value : plane(image, "R")) ASSERT_EQ(value, 0);
    }
  }
}

} // namespace
} // namespace isophote
