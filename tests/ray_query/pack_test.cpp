// What packScene makes for ray query, and what of it reaches the device.
#include <algorithm>

#include <gtest/gtest.h>

#include "isophote/error.hpp"
#include "isophote/gpu_scene.hpp"
#include "ray_query/ray_query_device.hpp"
#include "support/gpu_device.hpp"
#include "support/scenes.hpp"
#include "upload/pack_scene.hpp"

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
