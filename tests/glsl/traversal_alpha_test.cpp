#include <cmath>

#include <gtest/gtest.h>

#include "glsl/traversal_case.h"
#include "glsl/traversal_scene.hpp"
#include "support/gpu_device.hpp"
#include "support/probe.hpp"
#include "support/statistics.hpp"
#include "test_glsl_kernels.hpp"
#include "upload/gpu_scene.hpp"

using namespace isophote;
using gpu::TraversalCase;
using gpu::TraversalResult;

namespace {

constexpr uint32_t kSamples = 100000;

std::vector<TraversalResult> trace(const Scene& scene, const std::vector<TraversalCase>& rays) {
  return test::runOnScene<TraversalResult>(test_glsl_kernels::kernelSource("traversal_probe"),
                                           GpuScene(test::gpuDevice(), scene), rays);
}

// Sheets across the z axis at z = 0, 1, ..., all of one material, with uv = xy.
Scene sheets(uint32_t count, const Material& material) {
  std::vector<Mesh> meshes;
  for (uint32_t i = 0; i < count; ++i) {
    const auto z = static_cast<float>(i);
    Mesh mesh = test::meshOf({{0, 0, z}, {1, 0, z}, {1, 1, z}, {0, 1, z}}, {0, 1, 2, 0, 2, 3});
    mesh.primitives[0].uvs[0] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    meshes.push_back(mesh);
  }
  Scene scene = test::sceneOf(std::move(meshes));
  scene.materials[0].alphaMode = material.alphaMode;
  scene.materials[0].alphaCutoff = material.alphaCutoff;
  scene.materials[0].baseColor = material.baseColor;
  return scene;
}

std::vector<TraversalCase> samplesOfOneRay(glm::vec2 at, uint32_t count = kSamples) {
  std::vector<TraversalCase> rays(count);
  for (uint32_t i = 0; i < count; ++i)
    rays[i] = {.origin = {at, 100}, .direction = {0, 0, -1}, .tMax = 1e30f, .pixel = i % 640, .sampleIndex = i / 640};
  return rays;
}

Material blend(float alpha) {
  Material material;
  material.alphaMode = AlphaMode::Blend;
  material.baseColor.a = alpha;
  return material;
}

// An image whose alpha runs over four columns.
void addAlphaTexture(Scene& scene, const std::array<uint8_t, 4>& alphas) {
  ImageData image;
  image.width = 4;
  image.height = 1;
  for (const uint8_t alpha : alphas) {
    for (const uint8_t value : {uint8_t{255}, uint8_t{255}, uint8_t{255}, alpha})
      image.pixels.push_back(std::byte{value});
  }
  scene.images.push_back(image);
  scene.textures.push_back({.image = 0, .wrapS = Wrap::ClampToEdge, .filter = Filter::Nearest});
  scene.materials[0].baseColorTexture.texture = 0;
}

} // namespace

// Five tests at 1e-3 family-wise; 1e5 samples see a bias of 0.6% of the surface's opacity.
TEST(AlphaTest, BlendedSheetsStopTheirShareOfRays) {
  for (const float alpha : {0.1f, 0.5f, 0.9f}) {
    test::Moments first, second;
    for (const TraversalResult& result : trace(sheets(2, blend(alpha)), samplesOfOneRay({0.3f, 0.6f}))) {
      first.add(result.found && result.t < 99.5f ? 1 : 0);
      if (!result.found || result.t > 99.5f) second.add(result.found);
      ASSERT_EQ(result.found, result.occluded);
    }
    EXPECT_GT(test::meanTest(first, alpha), test::sidak(1e-3, 5)) << first.mean();
    EXPECT_GT(test::meanTest(second, alpha), test::sidak(1e-3, 5)) << second.mean();
  }
}

TEST(AlphaTest, SheetsOneBehindTheOtherDecideIndependently) {
  test::Moments passed;
  for (const TraversalResult& result : trace(sheets(4, blend(0.5f)), samplesOfOneRay({0.7f, 0.2f})))
    passed.add(result.found ? 0 : 1);
  EXPECT_GT(test::meanTest(passed, 1.0 / 16), 1e-3) << passed.mean();
}

TEST(AlphaTest, PathVerticesDecideIndependently) {
  std::vector<TraversalCase> rays = samplesOfOneRay({0.5f, 0.25f});
  const Scene scene = sheets(1, blend(0.5f));
  const auto first = trace(scene, rays);
  for (TraversalCase& ray : rays) ray.vertex = 1;
  const auto second = trace(scene, rays);
  test::Moments both;
  for (size_t i = 0; i < rays.size(); ++i) both.add(first[i].found && second[i].found ? 1 : 0);
  EXPECT_GT(test::meanTest(both, 0.25), 1e-3) << both.mean();
}

TEST(AlphaTest, MasksCutWhereTextureTimesFactorIsBelowTheCutoff) {
  Material mask;
  mask.alphaMode = AlphaMode::Mask;
  mask.alphaCutoff = 0.5f;
  mask.baseColor.a = 0.8f;
  Scene scene = sheets(1, mask);
  addAlphaTexture(scene, {0, 150, 170, 255}); // times 0.8: 0, 0.47, 0.53, 0.8
  std::vector<TraversalCase> rays;
  for (const float x : {0.125f, 0.375f, 0.625f, 0.875f}) rays.push_back(samplesOfOneRay({x, 0.4f}, 1)[0]);
  const auto results = trace(scene, rays);
  EXPECT_EQ(results[0].found, 0u);
  EXPECT_EQ(results[1].found, 0u);
  EXPECT_EQ(results[2].found, 1u);
  EXPECT_EQ(results[3].found, 1u);
}

TEST(AlphaTest, BlendsFollowTextureAndVertexColor) {
  Scene scene = sheets(1, blend(1));
  addAlphaTexture(scene, {0, 51, 255, 255});
  scene.meshes[0].primitives[0].colors.assign(4, glm::vec4(1, 1, 1, 0.5f));
  for (const auto& [x, alpha] : {std::pair{0.125f, 0.0}, {0.375f, 0.1}, {0.625f, 0.5}}) {
    test::Moments hits;
    for (const TraversalResult& result : trace(scene, samplesOfOneRay({x, 0.1f}))) hits.add(result.found);
    EXPECT_GT(test::meanTest(hits, alpha), test::sidak(1e-3, 3)) << hits.mean();
  }
}

TEST(AlphaTest, OpaqueMaterialsIgnoreAlpha) {
  Material opaque;
  opaque.baseColor.a = 0.1f;
  for (const TraversalResult& result : trace(sheets(1, opaque), samplesOfOneRay({0.5f, 0.25f}, 1000)))
    EXPECT_EQ(result.found, 1u);
}
