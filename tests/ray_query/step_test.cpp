// Rays that go on from a hit, as in glsl/traversal_step_test.cpp, through the device's acceleration structures: how a
// device rounds is its own affair, and still no ray may meet the surface that it leaves.
#include <gtest/gtest.h>

#include "glsl/traversal_case.h"
#include "glsl/traversal_scene.hpp"
#include "ray_query/ray_query_device.hpp"
#include "shared/geometry_types.h"
#include "support/probe.hpp"
#include "test_ray_query_kernels.hpp"
#include "upload/gpu_scene.hpp"

using namespace isophote;
using gpu::StepResult;
using gpu::TraversalCase;

namespace {

constexpr float kUnbounded = 3.402823466e38f;

std::vector<StepResult> step(const Device& device, const Scene& scene, const std::vector<TraversalCase>& rays) {
  const GpuScene onDevice(device, scene, Backend::RayQuery);
  const std::vector<gpu::SpecConstant> constants = test::featureConstants(onDevice.features());
  return test::runProbe<TraversalCase, StepResult>(
      test_ray_query_kernels::kernelSource("traversal_step_probe_ray_query"), rays,
      {.extra = onDevice.impl().view.address(), .constants = constants, .device = &device});
}

} // namespace

using RayQuerySteps = test::RayQueryTest;

TEST_F(RayQuerySteps, ThatLeaveAPlaneDoNotMeetItAgain) {
  // Planes turned any way, placed far away, stretched; and the floor y = 0, whose points have no error: rays leave it
  // by so little that the device itself meets it again.
  std::mt19937 random(2);
  for (uint32_t k = 0; k < 4; ++k) {
    Scene scene = test::sceneOf({test::meshOf({{-9, 0, -9}, {9, 0, -9}, {9, 0, 9}, {-9, 0, 9}}, {0, 1, 2, 0, 2, 3})});
    glm::dmat4& placement = scene.instances[0].worldFromObject;
    if (k > 0) placement = test::randomPlacement(random, 20); // farther away the device counts from the scene's center
    std::vector<TraversalCase> rays;
    const glm::dvec3 center(placement[3]);
    std::uniform_real_distribution<double> unit(-8, 8);
    for (uint32_t i = 0; i < 3000; ++i) {
      const glm::dvec3 target(placement * glm::dvec4(unit(random), 0, unit(random), 1));
      const glm::vec3 origin(center + 40.0 * glm::dvec3(test::randomDirection(random)));
      rays.push_back(
          {.origin = origin, .direction = glm::vec3(glm::normalize(target - glm::dvec3(origin))), .tMax = kUnbounded});
    }
    uint32_t hits = 0;
    for (const StepResult& result : step(device(), scene, rays)) {
      hits += result.first == 0;
      ASSERT_EQ(result.second, gpu::kInvalidIndex) << k;
      ASSERT_EQ(result.back, gpu::kInvalidIndex) << k;
    }
    EXPECT_GT(hits, 2900u);
  }
}

TEST_F(RayQuerySteps, FindBothOfTwoSpheresAHairApart) {
  for (const float radius : {1e-6f, 12.34f, 1e6f}) {
    const Scene scene = test::sceneOf({test::sphereMesh({0, 0, 0}, radius, 40), //
                                       test::sphereMesh({0, 0, 0}, radius * (1 + 4e-5f), 40)});
    std::mt19937 random(1);
    std::vector<TraversalCase> rays;
    for (uint32_t i = 0; i < 10000; ++i)
      rays.push_back({.origin = 0.2f * radius * test::randomDirection(random),
                      .direction = test::randomDirection(random),
                      .tMax = kUnbounded});
    uint32_t right = 0;
    for (const StepResult& result : step(device(), scene, rays)) {
      right += result.first == 0 && result.second == 1 && result.secondT < 1e-3f * radius && result.back == 0 &&
               result.backT > 0.1f * radius;
    }
    EXPECT_GE(right, rays.size() - 2) << radius; // the device may lose one at an edge
  }
}
