// What packScene makes for ray query, and what of it reaches the device.
#include <algorithm>

#include <gtest/gtest.h>

#include "glsl/traversal_scene.hpp"
#include "isophote/error.hpp"
#include "isophote/gpu_scene.hpp"
#include "ray_query/ray_query_device.hpp"
#include "support/gpu_device.hpp"
#include "support/scenes.hpp"
#include "upload/pack_scene.hpp"
#include "upload/place_order.hpp"

using namespace isophote;

using RayQueryScene = test::RayQueryTest;

TEST(RayQueryPacking, RangesHoldEveryTriangleOfTheirMeshOnceOpaqueOnesFirst) {
  const PackedScene packed = packScene(test::texturedStillLife(), Backend::RayQuery);
  EXPECT_TRUE(packed.nodes.empty());
  ASSERT_EQ(packed.triangleRanges.size(), packed.rangeStarts.size());
  uint32_t next = 0, withAlpha = 0;
  for (size_t i = 0; i < packed.triangleRanges.size(); ++i) {
    const TriangleRange& range = packed.triangleRanges[i];
    ASSERT_EQ(packed.rangeStarts[i], next);
    ASSERT_GT(range.count, 0u);
    ASSERT_GE(next, packed.meshTriangles[range.mesh]);
    next += range.count;
    ASSERT_LE(next, packed.meshTriangles[range.mesh + 1]);
    const TriangleRange* before = i > 0 ? &packed.triangleRanges[i - 1] : nullptr;
    ASSERT_TRUE(!before || before->mesh < range.mesh || (before->opaque && !range.opaque));
    for (uint32_t t = packed.rangeStarts[i]; t < next; ++t)
      ASSERT_EQ((packed.triangles[t].flags & gpu::kTriangleHasAlpha) == 0, range.opaque);
    if (!range.opaque) withAlpha += range.count;
  }
  EXPECT_EQ(next, packed.triangles.size());
  EXPECT_GT(withAlpha, 0u);
  EXPECT_LT(withAlpha, packed.triangles.size());
  EXPECT_TRUE(packScene(test::texturedStillLife()).triangleRanges.empty());
}

TEST(RayQueryPacking, SortingByPlaceKeepsEveryTriangleAndBringsNeighborsTogether) {
  std::vector<gpu::BvhTriangle> triangles;
  const std::vector<glm::vec3> soup = test::triangleSoup(2000, 0.01f, 21);
  for (uint32_t i = 0; i < 2000; ++i) triangles.push_back({soup[3 * i], i, soup[3 * i + 1], 0, soup[3 * i + 2], 0});
  const auto length = [&] { // of the way from each to the next
    double sum = 0;
    for (size_t i = 1; i < triangles.size(); ++i) sum += glm::distance(triangles[i - 1].v0, triangles[i].v0);
    return sum;
  };
  const double before = length();
  sortByPlace(triangles);
  EXPECT_LT(length(), 0.2 * before);
  std::vector<bool> seen(triangles.size());
  for (const gpu::BvhTriangle& triangle : triangles) {
    ASSERT_EQ(triangle.v0, soup[3 * triangle.primitiveIndex]);
    ASSERT_EQ(triangle.v2, soup[3 * triangle.primitiveIndex + 2]);
    seen[triangle.primitiveIndex] = true;
  }
  EXPECT_EQ(std::count(seen.begin(), seen.end(), true), 2000);
  sortByPlace({triangles.data(), 0});
  std::vector<gpu::BvhTriangle> flat(3, triangles[0]); // of no extent but the triangle's own
  sortByPlace(flat);
  EXPECT_EQ(flat[2].v1, triangles[0].v1);
}

TEST_F(RayQueryScene, HasNoNodesAndCountsItsBytes) {
  const GpuScene scene(device(), test::cornellBox(), Backend::RayQuery);
  const SceneStatistics& statistics = scene.statistics();
  EXPECT_EQ(statistics.backend, Backend::RayQuery);
  EXPECT_EQ(statistics.bvhNodes, 0u);
  EXPECT_GT(statistics.bvhBytes, 0u);
  uint64_t sum = 0;
  for (const BufferUse& use : statistics.buffers) {
    EXPECT_NE(use.name, "scene.nodes");
    sum += use.bytes;
  }
  EXPECT_EQ(statistics.sceneBytes + statistics.bvhBytes, sum);
  const GpuScene compute(device(), test::cornellBox());
  for (const BufferUse& use : compute.statistics().buffers) {
    EXPECT_NE(use.name, "scene.acceleration");
    EXPECT_NE(use.name, "scene.rangeStarts");
  }
}

TEST_F(RayQueryScene, GivesItsMemoryBack) {
  const uint64_t before = device().allocatedBytes();
  {
    GpuScene scene(device(), test::instanceGrid(), Backend::RayQuery);
    const GpuScene moved = std::move(scene);
    EXPECT_GT(device().allocatedBytes(), before);
  }
  EXPECT_EQ(device().allocatedBytes(), before);
}

TEST(RayQueryDevice, ADeviceMadeWithoutItRefusesSuchAScene) {
  EXPECT_THROW((void)GpuScene(test::gpuDevice(), test::cornellBox(), Backend::RayQuery), UsageError);
}
