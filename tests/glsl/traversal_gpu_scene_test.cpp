// What GpuScene puts on the device, and when it refuses.
#include <algorithm>

#include <gtest/gtest.h>

#include "glsl/traversal_scene.hpp"
#include "isophote/error.hpp"
#include "shared/geometry_types.h"
#include "support/gpu_device.hpp"

using namespace isophote;

namespace {

std::vector<std::string> bufferNames(const Scene& scene) {
  std::vector<std::string> names;
  const GpuScene gpuScene(test::gpuDevice(), scene);
  for (const BufferUse& use : gpuScene.statistics().buffers) names.push_back(use.name);
  std::sort(names.begin(), names.end());
  return names;
}

} // namespace

TEST(GpuScene, BuffersThatASceneDoesNotNeedDoNotExist) {
  EXPECT_EQ(bufferNames(Scene{}), std::vector<std::string>{"scene.view"});
  const Scene scene = test::sceneOf({test::meshOf(test::triangleSoup(5, 1, 1))});
  EXPECT_EQ(bufferNames(scene), (std::vector<std::string>{"scene.geometries", "scene.instances", "scene.materials",
                                                          "scene.nodes", "scene.triangles", "scene.view"}));
}

TEST(GpuScene, StatisticsCountEveryByteOnce) {
  const GpuScene scene(test::gpuDevice(), test::sceneOf({test::meshOf(test::triangleSoup(50, 1, 2))}));
  uint64_t sum = 0;
  for (const BufferUse& use : scene.statistics().buffers) sum += use.bytes;
  EXPECT_EQ(scene.statistics().sceneBytes + scene.statistics().bvhBytes, sum);
  EXPECT_EQ(scene.statistics().bvhBytes, scene.statistics().bvhNodes * sizeof(gpu::BvhNode));
}

TEST(GpuScene, TooLargeASceneIsRefusedBeforeAnythingIsUploaded) {
  Scene scene = test::sceneOf({test::meshOf(test::triangleSoup(5, 1, 3))});
  scene.images.resize(1); // 4 TiB by its header; its pixels would be read only by the upload
  scene.images[0].width = scene.images[0].height = 1u << 20;
  scene.textures.resize(1);
  scene.materials[0].baseColorTexture.texture = 0;
  const uint64_t before = test::gpuDevice().allocatedBytes();
  try {
    const GpuScene refused(test::gpuDevice(), scene);
    FAIL();
  } catch (const LimitError& error) {
    EXPECT_NE(std::string(error.what()).find("needs 43980465"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("available"), std::string::npos) << error.what();
  }
  EXPECT_EQ(test::gpuDevice().allocatedBytes(), before);
}
