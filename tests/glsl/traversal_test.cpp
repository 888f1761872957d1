#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "glsl/traversal_case.h"
#include "glsl/traversal_scene.hpp"
#include "isophote/settings.hpp"
#include "render/setting_ids.hpp"
#include "support/gpu_device.hpp"
#include "support/probe.hpp"
#include "support/statistics.hpp"
#include "test_glsl_kernels.hpp"
#include "upload/gpu_scene.hpp"

using namespace isophote;
using gpu::TraversalCase;
using gpu::TraversalResult;

namespace {

/// How the rays find what they meet.
struct Tracing {
  BvhBuild build = BvhBuild::FastTrace;
  std::span<const gpu::SpecConstant> settings = {};
};

std::vector<TraversalResult> trace(const Scene& scene, const std::vector<TraversalCase>& rays,
                                   const Tracing& how = {}) {
  return test::runOnScene<TraversalResult>(test_glsl_kernels::kernelSource("traversal_probe"),
                                           GpuScene(test::gpuDevice(), scene, Backend::Compute, how.build), rays,
                                           how.settings);
}

TraversalCase ray(glm::vec3 origin, glm::vec3 direction, float tMax = 3.402823466e38f) {
  return {.origin = origin, .tMin = 0, .direction = direction, .tMax = tMax};
}

std::vector<TraversalCase> randomRays(uint32_t count, float spread, uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(-1, 1);
  std::vector<TraversalCase> rays;
  for (uint32_t i = 0; i < count; ++i) {
    const glm::vec3 origin = spread * glm::vec3(unit(random), unit(random), unit(random));
    rays.push_back(ray(origin, test::randomDirection(random), i % 4 == 0 ? spread : 3.402823466e38f));
  }
  return rays;
}

// Every ray that brute force in double decides with some margin must come out the same. t carries the roundings of
// coordinates as large as `reach`: some 50 of 2^-24, and more where the ray meets the triangle at a flat angle.
void expectBruteForceHits(const Scene& scene, const std::vector<TraversalCase>& rays, double reach,
                          double shareOfHits = 0.2, const Tracing& how = {}) {
  const std::vector<TraversalResult> results = trace(scene, rays, how);
  uint32_t hits = 0, misses = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    const TraversalResult& result = results[i];
    ASSERT_EQ(result.stackOverflow, 0u);
    ASSERT_EQ(result.found, result.occluded) << i;
    const auto expected = test::bruteForceHit(scene, rays[i].origin, rays[i].direction, rays[i].tMax);
    if (expected && expected->margin < 1e-4) continue;
    ASSERT_EQ(result.found, expected ? 1u : 0u) << "ray " << i;
    (expected ? hits : misses) += 1;
    if (!expected) continue;
    ASSERT_EQ(result.primitiveIndex, expected->triangle) << "ray " << i;
    ASSERT_NEAR(result.t, expected->t, 1e-5 * expected->t + 3e-6 * reach) << "ray " << i;
    ASSERT_NEAR(result.barycentrics.x, expected->barycentrics.x, 1e-4) << "ray " << i;
    ASSERT_NEAR(result.barycentrics.y, expected->barycentrics.y, 1e-4) << "ray " << i;
  }
  EXPECT_GT(hits, shareOfHits * static_cast<double>(rays.size()));
  EXPECT_GT(misses, rays.size() / 50);
}

Scene instancedScene(uint32_t meshes, uint32_t instances, uint32_t seed) {
  std::vector<Mesh> list;
  for (uint32_t i = 0; i < meshes; ++i) list.push_back(test::meshOf(test::triangleSoup(7 + 10 * i, 0.8f, seed + i)));
  Scene scene = test::sceneOf(std::move(list));
  scene.instances.clear();
  std::mt19937 random(seed);
  for (uint32_t i = 0; i < instances; ++i) {
    Instance instance;
    instance.mesh = i % meshes;
    instance.worldFromObject = test::randomPlacement(random, 8);
    scene.instances.push_back(instance);
  }
  return scene;
}

} // namespace

TEST(Traversal, FindsWhatBruteForceFindsInATriangleSoup) {
  const Scene scene = test::sceneOf({test::meshOf(test::triangleSoup(600, 0.3f, 1))});
  expectBruteForceHits(scene, randomRays(8000, 1.5f, 2), 1);
}

TEST(Traversal, FindsWhatBruteForceFindsAmongMirroredAndStretchedInstances) {
  expectBruteForceHits(instancedScene(4, 60, 3), randomRays(6000, 10, 4), 10);
}

TEST(Traversal, TheFastTestFindsTheSameAwayFromEdges) {
  const gpu::SpecConstant fast[] = {{setting_id::kIntersection, static_cast<uint32_t>(Intersection::Fast)}};
  const Scene scene = test::sceneOf({test::meshOf(test::triangleSoup(600, 0.3f, 6))});
  expectBruteForceHits(scene, randomRays(8000, 1.5f, 7), 1, 0.2, {.settings = fast});
}

// Among them triangles of no area, and more copies of one triangle than the builder looks at together.
TEST(Traversal, FindsWhatBruteForceFindsInAFastTree) {
  std::vector<glm::vec3> positions = test::triangleSoup(3000, 0.15f, 5);
  for (size_t i = 0; i < 600; ++i) {
    const glm::vec3 a = positions[3 * i], b = positions[3 * i + 1];
    positions.insert(positions.end(), {a, a, a, a, b, a});
  }
  for (int copy = 0; copy < 1100; ++copy) positions.insert(positions.end(), {{2, 2, 2}, {2.1f, 2, 2}, {2, 2.1f, 2}});
  expectBruteForceHits(test::sceneOf({test::meshOf(positions)}), randomRays(1500, 1.5f, 6), 1, 0.2,
                       {.build = BvhBuild::FastBuild});
}

// Of many sizes: spheres of 3,480 triangles, and a soup that is fine in one corner and coarse elsewhere.
TEST(Traversal, FastTreesFindTheHitsOfGoodOnes) {
  std::mt19937 random(7);
  std::vector<Mesh> meshes{test::meshOf(test::triangleSoup(20000, 0.1f, 8))};
  std::vector<glm::vec3> fine = test::triangleSoup(20000, 0.1f, 9);
  for (glm::vec3& position : fine) position = glm::vec3(0.7f) + 0.01f * position;
  meshes.push_back(test::meshOf(fine));
  for (int i = 0; i < 4; ++i) meshes.push_back(test::sphereMesh(0.8f * test::randomDirection(random), 0.3f, 30));
  const Scene scene = test::sceneOf(std::move(meshes));
  std::vector<TraversalCase> rays = randomRays(20000, 1.5f, 10);
  for (size_t i = 0; i < rays.size(); i += 2) // to where it is fine
    rays[i].direction = glm::vec3(0.7f) + 0.01f * test::randomDirection(random) - rays[i].origin;
  const auto good = trace(scene, rays);
  const auto fast = trace(scene, rays, {.build = BvhBuild::FastBuild});
  uint32_t hits = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    ASSERT_EQ(fast[i].stackOverflow, 0u);
    ASSERT_EQ(fast[i].found, good[i].found) << i;
    ASSERT_EQ(fast[i].occluded, good[i].occluded) << i;
    if (good[i].found == 0) continue;
    ++hits;
    ASSERT_EQ(fast[i].t, good[i].t) << i; // the same arithmetic
    ASSERT_EQ(fast[i].geometry, good[i].geometry) << i;
    ASSERT_EQ(fast[i].primitiveIndex, good[i].primitiveIndex) << i;
  }
  EXPECT_GT(hits, rays.size() / 2);
}

TEST(Traversal, FindsTheOneTriangleOfATinyScene) {
  const Scene scene = test::sceneOf({test::meshOf({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})});
  const auto results = trace(scene, {ray({0.25f, 0.25f, 2}, {0, 0, -1}), ray({0.25f, 0.25f, 2}, {0, 0, -2}),
                                     ray({0.75f, 0.75f, 2}, {0, 0, -1}), ray({0.25f, 0.25f, -2}, {0, 0, 1})});
  EXPECT_EQ(results[0].found, 1u);
  EXPECT_FLOAT_EQ(results[0].t, 2);
  EXPECT_FLOAT_EQ(results[1].t, 1); // in units of the direction's length
  EXPECT_EQ(results[2].found, 0u);
  EXPECT_EQ(results[3].found, 1u); // no culling
}

TEST(Traversal, AnEmptySceneIsMissed) {
  for (const TraversalResult& result : trace(Scene{}, randomRays(100, 1, 5))) {
    EXPECT_EQ(result.found, 0u);
    EXPECT_EQ(result.occluded, 0u);
  }
}

TEST(Traversal, HitsLieBetweenTMinAndTMax) {
  std::vector<Mesh> layers;
  for (int z = 1; z <= 8; ++z) {
    const auto height = static_cast<float>(z);
    layers.push_back(test::meshOf({{-1, -1, height}, {3, -1, height}, {-1, 3, height}}));
  }
  TraversalCase bounded = ray({0, 0, 0}, {0, 0, 1}, 6.5f);
  bounded.tMin = 4.5f;
  TraversalCase between = bounded;
  between.tMin = 4.25f;
  between.tMax = 4.75f;
  const auto results = trace(test::sceneOf(layers), {bounded, between});
  EXPECT_FLOAT_EQ(results[0].t, 5);
  EXPECT_EQ(results[1].found + results[1].occluded, 0u);
}

TEST(Traversal, EqualDistancesGoToTheSmallerInstanceAndTriangle) {
  const glm::vec3 a(-1, -1, 0), b(3, -1, 0), c(-1, 3, 0);
  std::vector<glm::vec3> positions;
  for (int copy = 0; copy < 37; ++copy) positions.insert(positions.end(), {a, b, c});
  Scene scene = test::sceneOf({test::meshOf(positions)});
  scene.instances.resize(23, scene.instances[0]);
  for (const TraversalResult& result :
       trace(scene, {ray({0, 0, 5}, {0, 0, -1}), ray({0.1f, 0.2f, -5}, {0, 0, 1}), ray({4, 5, 6}, {-4, -5, -6})})) {
    EXPECT_EQ(result.found, 1u);
    EXPECT_EQ(result.instance, 0u);
    EXPECT_EQ(result.triangle, 0u);
  }
}

TEST(Traversal, RaysAlongAxesOnFacesOfBoxesFindTheGridBehind) {
  // A 16 x 16 grid in the plane x = 0 with vertices at integers: rays with two zero components start on integer lines,
  // where they run along faces of the boxes and through vertices and edges.
  std::vector<glm::vec3> positions;
  std::vector<uint32_t> indices;
  for (uint32_t y = 0; y <= 16; ++y) {
    for (uint32_t z = 0; z <= 16; ++z) positions.push_back({0, static_cast<float>(y), static_cast<float>(z)});
  }
  for (uint32_t y = 0; y < 16; ++y) {
    for (uint32_t z = 0; z < 16; ++z) {
      const uint32_t i = 17 * y + z;
      indices.insert(indices.end(), {i, i + 1, i + 17, i + 1, i + 18, i + 17});
    }
  }
  std::vector<TraversalCase> rays;
  for (const float zero : {0.0f, -0.0f}) {
    for (uint32_t y = 0; y <= 32; ++y) {
      for (uint32_t z = 0; z <= 32; ++z) {
        rays.push_back(ray({-3, 0.5f * static_cast<float>(y), 0.5f * static_cast<float>(z)}, {1, zero, zero}));
        rays.push_back(ray({3, 0.5f * static_cast<float>(y), 0.5f * static_cast<float>(z)}, {-1, zero, -zero}));
      }
    }
  }
  for (const TraversalResult& result : trace(test::sceneOf({test::meshOf(positions, indices)}), rays)) {
    ASSERT_EQ(result.found, 1u);
    ASSERT_EQ(result.occluded, 1u);
    ASSERT_EQ(result.t, 3.0f);
  }
}

TEST(Traversal, RaysThatAreNotNumbersEnd) {
  const float nan = std::nanf("");
  const float infinity = std::numeric_limits<float>::infinity();
  const auto results = trace(instancedScene(2, 10, 8), {ray({nan, 0, 0}, {0, 0, 1}), ray({0, 0, 0}, {nan, nan, nan}),
                                                        ray({infinity, 0, 0}, {-1, 0, 0}), ray({0, 0, 0}, {0, 0, 0}),
                                                        ray({0, 0, 0}, {infinity, 0, 0})});
  EXPECT_EQ(results.size(), 5u);
}

TEST(Traversal, ManyInstancesOfOneMeshAreStoredOnce) {
  Scene scene = test::sceneOf({test::meshOf(test::triangleSoup(20, 0.5f, 12))});
  scene.instances.clear();
  for (uint32_t i = 0; i < 10000; ++i) {
    Instance instance;
    instance.worldFromObject[3] = glm::dvec4(4.0 * (i % 100), 4.0 * (i / 100), 0, 1);
    scene.instances.push_back(instance);
  }
  const GpuScene gpuScene(test::gpuDevice(), scene);
  EXPECT_EQ(gpuScene.statistics().triangles, 20u);
  EXPECT_EQ(gpuScene.statistics().instancedTriangles, 200000u);
  EXPECT_LT(gpuScene.statistics().sceneBytes + gpuScene.statistics().bvhBytes, 10000 * 200u);

  std::vector<TraversalCase> rays;
  std::mt19937 random(13);
  std::uniform_real_distribution<float> unit(-1, 1);
  for (uint32_t i = 0; i < 400; ++i) {
    const glm::vec3 target(4.0f * static_cast<float>(i % 20), 4.0f * static_cast<float>(i / 20), 0);
    rays.push_back(ray(target + glm::vec3(unit(random), unit(random), 5), {0.01f, 0.02f, -1}));
  }
  scene.instances.resize(2500); // the rays reach no others; brute force in double is slow
  std::erase_if(scene.instances, [](const Instance& i) { return i.worldFromObject[3].x > 84; });
  expectBruteForceHits(scene, rays, 80, 0.1);
}

TEST(Traversal, NeedlesOfAMillionToOneAreHit) {
  // A fan of needles 1e-6 wide and 1 long tiles a strip; rays across it hit whatever needle they are aimed at.
  std::vector<glm::vec3> positions;
  std::vector<uint32_t> indices;
  for (uint32_t i = 0; i <= 200; ++i) {
    positions.push_back({1e-6f * static_cast<float>(i), 0, 0});
    positions.push_back({1e-6f * static_cast<float>(i), 1, 0});
  }
  for (uint32_t i = 0; i < 200; ++i) {
    const uint32_t a = 2 * i;
    indices.insert(indices.end(), {a, a + 2, a + 1, a + 2, a + 3, a + 1});
  }
  std::mt19937 random(14);
  std::uniform_real_distribution<float> unit(0, 1);
  std::vector<TraversalCase> rays;
  for (uint32_t i = 0; i < 5000; ++i)
    rays.push_back(ray({1e-6f + 1.98e-4f * unit(random), unit(random), 1}, {0, 0, -1}));
  for (const TraversalResult& result : trace(test::sceneOf({test::meshOf(positions, indices)}), rays)) {
    ASSERT_EQ(result.found, 1u);
    ASSERT_TRUE(std::isfinite(result.t));
    ASSERT_GE(result.barycentrics.x, 0);
    ASSERT_GE(result.barycentrics.y, 0);
    ASSERT_LE(result.barycentrics.x + result.barycentrics.y, 1.000001f);
  }
}
