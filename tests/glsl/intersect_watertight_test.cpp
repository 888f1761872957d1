// A closed surface, rays from inside: whatever they are aimed at, none gets out.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "glsl/traversal_case.h"
#include "glsl/traversal_scene.hpp"
#include "isophote/settings.hpp"
#include "render/setting_ids.hpp"
#include "support/gpu_device.hpp"
#include "support/probe.hpp"
#include "test_glsl_kernels.hpp"
#include "upload/gpu_scene.hpp"

using namespace isophote;
using gpu::TraversalCase;
using gpu::TraversalResult;

namespace {

// Where Embree's own test of watertightness places its sphere.
constexpr glm::vec3 kFarPosition(148376.0f, 1234.0f, -223423.0f);

struct Misses {
  uint32_t closest = 0, occlusion = 0;
};

// Aims rays from around `center` at vertices, edges and insides of the mesh in equal parts, and at random.
Misses countMisses(const Scene& scene, glm::vec3 center, float spread, uint32_t count, uint32_t seed,
                   std::span<const gpu::SpecConstant> settings = {}) {
  const GpuScene gpuScene(test::gpuDevice(), scene);
  const glm::dvec3 shift = gpuScene.impl().worldOrigin;
  const glm::dmat4& worldFromObject = scene.instances[0].worldFromObject;
  const Primitive& primitive = scene.meshes[0].primitives[0];
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(-1, 1);
  std::uniform_real_distribution<double> share(0, 1);
  std::vector<TraversalCase> rays;
  for (uint32_t i = 0; i < count; ++i) {
    const glm::vec3 origin(glm::dvec3(center + spread * glm::vec3(unit(random), unit(random), unit(random))) - shift);
    const size_t triangle = random() % (primitive.indices.size() / 3);
    const auto corner = [&](size_t k) {
      const glm::dvec4 position(primitive.positions[primitive.indices[3 * triangle + k]], 1);
      return glm::dvec3(worldFromObject * position) - shift;
    };
    glm::dvec3 target = corner(0);
    if (i % 4 == 1) target += share(random) * (corner(1) - corner(0));
    if (i % 4 == 2) target += 0.4 * (corner(1) - corner(0)) + 0.4 * share(random) * (corner(2) - corner(0));
    const glm::vec3 direction =
        i % 4 == 3 ? test::randomDirection(random) : glm::vec3(glm::normalize(target - glm::dvec3(origin)));
    rays.push_back({.origin = origin, .direction = direction, .tMax = 3.402823466e38f});
  }
  Misses misses;
  for (const TraversalResult& result : test::runOnScene<TraversalResult>(
           test_glsl_kernels::kernelSource("traversal_probe"), gpuScene, rays, settings)) {
    misses.closest += result.found == 0;
    misses.occlusion += result.occluded == 0;
  }
  return misses;
}

} // namespace

TEST(Watertight, NoRayLeavesASphereAtTheOrigin) {
  for (const uint32_t rings : {25u, 100u}) {
    const Misses misses =
        countMisses(test::sceneOf({test::sphereMesh({0, 0, 0}, 2, rings)}), {0, 0, 0}, 0.5f, 200000, 1);
    EXPECT_EQ(misses.closest, 0u);
    EXPECT_EQ(misses.occlusion, 0u);
  }
}

// What intersection=fast trades away: of these rays, half are aimed at vertices or edges.
TEST(Watertight, TheFastTestLosesRaysAtEdges) {
  const gpu::SpecConstant fast[] = {{setting_id::kIntersection, static_cast<uint32_t>(Intersection::Fast)}};
  const Misses misses =
      countMisses(test::sceneOf({test::sphereMesh({0, 0, 0}, 2, 100)}), {0, 0, 0}, 0.5f, 200000, 1, fast);
  EXPECT_GT(misses.closest, 0u);
}

TEST(Watertight, NoRayLeavesASphereWithFarVertices) {
  const Scene scene = test::sceneOf({test::sphereMesh(kFarPosition, 2, 50)});
  const Misses misses = countMisses(scene, kFarPosition, 0.5f, 400000, 2);
  EXPECT_EQ(misses.closest, 0u);
  EXPECT_EQ(misses.occlusion, 0u);
}

// Number 39 of the reliability list with its number of rays: two spheres, 5e6 rays each.
TEST(WatertightSlow, Test39TenMillionRaysStayInside) {
  for (const uint32_t rings : {25u, 100u}) { // 50 and 200 parts around
    const Scene scene = test::sceneOf({test::sphereMesh(kFarPosition, 2, rings)});
    for (uint32_t part = 0; part < 5; ++part) {
      const Misses misses = countMisses(scene, kFarPosition, 0.5f, 1000000, 100 * rings + part);
      EXPECT_EQ(misses.closest, 0u);
      EXPECT_EQ(misses.occlusion, 0u);
    }
  }
}

TEST(Watertight, NoRayLeavesASpherePlacedFarAway) {
  Scene scene = test::sceneOf({test::sphereMesh({0, 0, 0}, 2, 50)});
  scene.instances[0].worldFromObject[3] = glm::dvec4(kFarPosition, 1);
  const Misses misses = countMisses(scene, kFarPosition, 0.5f, 200000, 3);
  EXPECT_EQ(misses.closest, 0u);
  EXPECT_EQ(misses.occlusion, 0u);
}

TEST(Watertight, NoRayLeavesATurnedAndMirroredSphere) {
  std::mt19937 random(4);
  Scene scene = test::sceneOf({test::sphereMesh({0, 0, 0}, 2, 50)});
  scene.instances[0].worldFromObject = test::randomPlacement(random, 1);
  const glm::vec3 center(scene.instances[0].worldFromObject[3]);
  const Misses misses = countMisses(scene, center, 0.2f, 200000, 5);
  EXPECT_EQ(misses.closest, 0u);
  EXPECT_EQ(misses.occlusion, 0u);
}

TEST(Watertight, NoRayLeavesASphereOfAnySize) {
  for (const float radius : {1e-22f, 1e-12f, 1e6f, 1e12f}) {
    const Scene scene = test::sceneOf({test::sphereMesh({0, 0, 0}, radius, 25)});
    const Misses misses = countMisses(scene, {0, 0, 0}, 0.3f * radius, 40000, 6);
    EXPECT_EQ(misses.closest, 0u) << radius;
    EXPECT_EQ(misses.occlusion, 0u) << radius;
  }
}

TEST(Watertight, NoRayLeavesABoxAlongItsFacesAndDiagonals) {
  // Edges parallel to the axes lie on the borders of boxes.
  std::vector<glm::vec3> positions;
  for (uint32_t i = 0; i < 8; ++i) positions.push_back({i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1});
  const std::vector<uint32_t> indices{0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5, 0, 4, 5, 0, 5, 1,
                                      2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3};
  const Misses misses = countMisses(test::sceneOf({test::meshOf(positions, indices)}), {0, 0, 0}, 0.9999f, 400000, 7);
  EXPECT_EQ(misses.closest, 0u);
  EXPECT_EQ(misses.occlusion, 0u);
}

TEST(Watertight, RaysAtCentersOfSmallTrianglesFindThem) {
  // Number 40 of the reliability list: a 100 x 100 plane from 10 units above and to the side.
  std::vector<glm::vec3> positions;
  std::vector<uint32_t> indices;
  for (uint32_t y = 0; y <= 100; ++y) {
    for (uint32_t x = 0; x <= 100; ++x)
      positions.push_back({0.01f * static_cast<float>(x), 0, 0.01f * static_cast<float>(y)});
  }
  for (uint32_t y = 0; y < 100; ++y) {
    for (uint32_t x = 0; x < 100; ++x) {
      const uint32_t i = 101 * y + x;
      indices.insert(indices.end(), {i, i + 101, i + 1, i + 1, i + 101, i + 102});
    }
  }
  const Scene scene = test::sceneOf({test::meshOf(positions, indices)});
  std::vector<TraversalCase> rays;
  for (size_t i = 0; i < indices.size(); i += 3) {
    const glm::vec3 target = (positions[indices[i]] + positions[indices[i + 1]] + positions[indices[i + 2]]) / 3.0f;
    const glm::vec3 origin(-7, 10, 3);
    rays.push_back({.origin = origin, .direction = glm::normalize(target - origin), .tMax = 1e30f});
  }
  const GpuScene gpuScene(test::gpuDevice(), scene);
  const auto results =
      test::runOnScene<TraversalResult>(test_glsl_kernels::kernelSource("traversal_probe"), gpuScene, rays);
  for (size_t i = 0; i < results.size(); ++i) {
    ASSERT_EQ(results[i].found, 1u);
    ASSERT_EQ(results[i].primitiveIndex, i);
  }
}
