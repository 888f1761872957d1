// What rays cost in steps, whatever the machine: grown figures are a change of tree or order for the worse.
#include <array>

#include <gtest/gtest.h>

#include "glsl/traversal_case.h"
#include "glsl/traversal_scene.hpp"
#include "support/gpu_device.hpp"
#include "support/probe.hpp"
#include "test_glsl_kernels.hpp"

using namespace isophote;
using gpu::StepCountResult;
using gpu::TraversalCase;

namespace {

struct Cost {
  double turns = 0, nodes = 0, triangles = 0, instances = 0; ///< per ray; a turn of the loop takes one step or two
};

// Spheres of 3,480 triangles among small ones scattered at random, in one mesh, placed `copies` times.
Scene crowd(uint32_t copies) {
  std::mt19937 random(1);
  Primitive all;
  const auto add = [&](const Mesh& mesh) {
    const Primitive& part = mesh.primitives[0];
    const auto first = static_cast<uint32_t>(all.positions.size());
    all.positions.insert(all.positions.end(), part.positions.begin(), part.positions.end());
    for (const uint32_t index : part.indices) all.indices.push_back(first + index);
  };
  for (int i = 0; i < 6; ++i) add(test::sphereMesh(0.7f * test::randomDirection(random), 0.25f, 30));
  add(test::meshOf(test::triangleSoup(6000, 0.05f, 2)));
  Mesh mesh;
  mesh.primitives.push_back(std::move(all));
  Scene scene = test::sceneOf({std::move(mesh)});
  scene.instances.resize(copies, scene.instances[0]);
  for (uint32_t i = 1; i < copies; ++i) scene.instances[i].worldFromObject[3] = glm::dvec4(1.5 * i, 0.3 * i, 0, 1);
  return scene;
}

// Mean cost of rays that begin among the triangles; [0] closest hits, [1] occlusion.
std::array<Cost, 2> cost(const Scene& scene, BvhBuild build = BvhBuild::FastTrace) {
  std::mt19937 random(3);
  std::vector<TraversalCase> rays;
  for (uint32_t i = 0; i < 4096; ++i) {
    rays.push_back({.origin = 0.9f * test::randomDirection(random),
                    .direction = test::randomDirection(random),
                    .tMax = 3.402823466e38f});
  }
  std::array<Cost, 2> result;
  for (const StepCountResult& ray :
       test::runOnScene<StepCountResult>(test_glsl_kernels::kernelSource("traversal_count_probe"),
                                         GpuScene(test::gpuDevice(), scene, Backend::Compute, build), rays)) {
    for (size_t k = 0; k < 2; ++k) {
      result[k].turns += ray.turns[k] / 4096.0;
      result[k].nodes += ray.nodes[k] / 4096.0;
      result[k].triangles += ray.triangles[k] / 4096.0;
      result[k].instances += ray.instances[k] / 4096.0;
    }
  }
  return result;
}

// Other devices round otherwise, so that single rays may differ.
constexpr double kMargin = 1.02;

void expectAtMost(const Cost& cost, const Cost& recorded) {
  EXPECT_LE(cost.turns, kMargin * recorded.turns);
  EXPECT_LE(cost.nodes, kMargin * recorded.nodes);
  EXPECT_LE(cost.triangles, kMargin * recorded.triangles);
  EXPECT_LE(cost.instances, kMargin * recorded.instances);
  EXPECT_GT(cost.nodes, 0.7 * recorded.nodes) << "better by far: record the new figures";
  testing::Test::RecordProperty("turns", std::to_string(cost.turns));
  testing::Test::RecordProperty("nodes", std::to_string(cost.nodes));
  testing::Test::RecordProperty("triangles", std::to_string(cost.triangles));
}

} // namespace

TEST(TraversalCost, OneMeshCostsNoMoreStepsThanRecorded) {
  const auto [closest, occluded] = cost(crowd(1));
  expectAtMost(closest, {.turns = 15.74, .nodes = 14.98, .triangles = 2.35, .instances = 1});
  expectAtMost(occluded, {.turns = 14.09, .nodes = 13.60, .triangles = 2.00, .instances = 1});
}

TEST(TraversalCost, OverlappingCopiesCostNoMoreStepsThanRecorded) {
  const auto [closest, occluded] = cost(crowd(5));
  expectAtMost(closest, {.turns = 21.77, .nodes = 20.20, .triangles = 3.17, .instances = 1.56});
  expectAtMost(occluded, {.turns = 17.32, .nodes = 16.41, .triangles = 2.41, .instances = 1.34});
}

TEST(TraversalCost, AFastTreeCostsNoMoreStepsThanRecorded) {
  const auto [closest, occluded] = cost(crowd(1), BvhBuild::FastBuild);
  expectAtMost(closest, {.turns = 16.51, .nodes = 14.77, .triangles = 2.36, .instances = 1});
  expectAtMost(occluded, {.turns = 14.63, .nodes = 13.18, .triangles = 1.97, .instances = 1});
}
