// worldBounds is tight, framingCamera sees all of it.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "isophote/error.hpp"
#include "isophote/scene.hpp"

using namespace isophote;

namespace {

Scene boxScene(glm::dvec3 center, glm::dvec3 halfSize) {
  Scene scene;
  Primitive primitive;
  for (int i = 0; i < 8; ++i) primitive.positions.emplace_back(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
  primitive.indices = {0, 1, 2, 4, 5, 6, 3, 7, 1};
  scene.meshes.push_back({"box", {primitive}});
  scene.instances.push_back({0, glm::scale(glm::translate(glm::dmat4(1), center), halfSize), ""});
  return scene;
}

/// The largest |x| / width or |y| / height of any corner of the bounds in the image; 1 is the edge of the frame.
double largestImageCoordinate(const Scene& scene, const Camera& camera) {
  const Bounds bounds = worldBounds(scene);
  const double tanY = std::tan(0.5 * camera.yfov);
  double largest = 0;
  for (int i = 0; i < 8; ++i) {
    const glm::dvec3 corner(i & 1 ? bounds.upper.x : bounds.lower.x, i & 2 ? bounds.upper.y : bounds.lower.y,
                            i & 4 ? bounds.upper.z : bounds.lower.z);
    const glm::dvec4 local = glm::inverse(camera.worldFromCamera) * glm::dvec4(corner, 1);
    EXPECT_LT(local.z, 0) << "in front of the camera";
    largest = std::max(
        {largest, std::abs(local.x) / (-local.z * tanY * *camera.aspectRatio), std::abs(local.y) / (-local.z * tanY)});
  }
  return largest;
}

} // namespace

TEST(WorldBounds, AreTightForRotatedInstances) {
  Scene scene = boxScene({5, 0, 0}, {1, 1, 1});
  scene.instances[0].worldFromObject =
      glm::rotate(glm::translate(glm::dmat4(1), glm::dvec3(5, 0, 0)), glm::radians(45.0), glm::dvec3(0, 0, 1));
  // A vertex list without its corners: the box around the rotated box would be larger than this.
  scene.meshes[0].primitives[0].positions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}};
  const Bounds bounds = worldBounds(scene);
  const double h = std::sqrt(0.5);
  EXPECT_NEAR(bounds.lower.x, 5 - h, 1e-12);
  EXPECT_NEAR(bounds.upper.x, 5 + h, 1e-12);
  EXPECT_NEAR(bounds.upper.y, h, 1e-12);
  EXPECT_NEAR(bounds.upper.z, 0, 1e-12);
}

TEST(WorldBounds, CoverAllInstances) {
  Scene scene = boxScene({0, 0, 0}, {1, 1, 1});
  scene.instances.push_back({0, glm::translate(glm::dmat4(1), glm::dvec3(0.0, 9.0, 0.0)), ""});
  scene.instances.push_back({0, glm::scale(glm::dmat4(1), glm::dvec3(0.5)), ""});
  const Bounds bounds = worldBounds(scene);
  EXPECT_EQ(bounds.lower, glm::dvec3(-1));
  EXPECT_EQ(bounds.upper, glm::dvec3(1, 10, 1));
}

TEST(WorldBounds, OfAnEmptySceneAreEmpty) { EXPECT_TRUE(worldBounds(Scene{}).empty()); }

TEST(FramingCamera, SeesAllOfTheBoundsAndFillsTheFrame) {
  for (const glm::dvec3 size :
       {glm::dvec3(1), glm::dvec3(10, 0.1, 0.1), glm::dvec3(0.1, 10, 0.1), glm::dvec3(1e-6), glm::dvec3(1e6)}) {
    for (const double aspect : {0.25, 1.0, 16.0 / 9.0, 4.0}) {
      const Scene scene = boxScene({3, -2, 7}, size);
      const Camera camera = framingCamera(scene, aspect);
      EXPECT_NEAR(camera.yfov, glm::radians(45.0), 1e-12);
      const double largest = largestImageCoordinate(scene, camera);
      EXPECT_LT(largest, 1.0) << size.x << " " << aspect;
      EXPECT_GT(largest, 0.5) << size.x << " " << aspect;
    }
  }
}

TEST(FramingCamera, LooksAtTheCenterAndStandsUpright) {
  const Camera camera = framingCamera(boxScene({3, -2, 7}, {1, 1, 1}), 1.5);
  const glm::dvec4 center = glm::inverse(camera.worldFromCamera) * glm::dvec4(3, -2, 7, 1);
  EXPECT_NEAR(center.x, 0, 1e-12);
  EXPECT_NEAR(center.y, 0, 1e-12);
  EXPECT_LT(center.z, 0);
  EXPECT_NEAR(camera.worldFromCamera[0].y, 0, 1e-12) << "no roll";
  EXPECT_GT(camera.worldFromCamera[1].y, 0);
  EXPECT_NEAR(glm::determinant(camera.worldFromCamera), 1, 1e-12);
}

TEST(FramingCamera, IsSensibleForAnEmptyScene) {
  const Camera camera = framingCamera(Scene{}, 1);
  EXPECT_GT(glm::length(glm::dvec3(camera.worldFromCamera[3])), 1);
  EXPECT_LT(glm::length(glm::dvec3(camera.worldFromCamera[3])), 100);
}

TEST(FramingCamera, RefusesAnImpossibleAspectRatio) {
  EXPECT_THROW((void)framingCamera(Scene{}, 0), UsageError);
  EXPECT_THROW((void)framingCamera(Scene{}, std::nan("")), UsageError);
}
