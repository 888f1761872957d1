// Rays that go on from a hit: they meet what is next, not what they left.
#include <gtest/gtest.h>

#include "glsl/traversal_case.h"
#include "glsl/traversal_scene.hpp"
#include "shared/geometry_types.h"
#include "support/gpu_device.hpp"
#include "support/probe.hpp"
#include "test_glsl_kernels.hpp"
#include "upload/gpu_scene.hpp"

using namespace isophote;
using gpu::StepResult;
using gpu::TraversalCase;

namespace {

std::vector<StepResult> step(const Scene& scene, const std::vector<TraversalCase>& rays) {
  return test::runOnScene<StepResult>(test_glsl_kernels::kernelSource("traversal_step_probe"),
                                      GpuScene(test::gpuDevice(), scene), rays);
}

} // namespace

TEST(Steps, BothOfTwoSpheresAHairApartAreHit) {
  // Number 42 of the reliability list, in sizes from a micrometre to 1e6 m.
  for (const float radius : {1e-6f, 1.0f, 12.34f, 1e6f}) {
    const Scene scene = test::sceneOf({test::sphereMesh({0, 0, 0}, radius, 40), //
                                       test::sphereMesh({0, 0, 0}, radius * (1 + 4e-5f), 40)});
    std::mt19937 random(1);
    std::vector<TraversalCase> rays;
    for (uint32_t i = 0; i < 20000; ++i)
      rays.push_back({.origin = 0.2f * radius * test::randomDirection(random),
                      .direction = test::randomDirection(random),
                      .tMax = 3.402823466e38f});
    for (const StepResult& result : step(scene, rays)) {
      ASSERT_EQ(result.first, 0u) << radius;
      ASSERT_EQ(result.second, 1u) << radius;
      ASSERT_LT(result.secondT, 1e-3f * radius);
      ASSERT_EQ(result.back, 0u) << radius;
      ASSERT_GT(result.backT, 0.1f * radius);
    }
  }
}

TEST(Steps, RaysThatLeaveAPlaneDoNotMeetItAgain) {
  // Planes turned any way, placed far away, stretched: the ray onwards and the ray back meet nothing.
  std::mt19937 random(2);
  for (uint32_t k = 0; k < 5; ++k) {
    Scene scene = test::sceneOf({test::meshOf({{-9, -9, 3}, {9, -9, 3}, {9, 9, 3}, {-9, 9, 3}}, {0, 1, 2, 0, 2, 3})});
    glm::dmat4& placement = scene.instances[0].worldFromObject;
    placement = test::randomPlacement(random, 100);
    std::vector<TraversalCase> rays;
    const glm::dvec3 center(placement * glm::dvec4(0, 0, 3, 1));
    std::uniform_real_distribution<double> unit(-8, 8);
    for (uint32_t i = 0; i < 5000; ++i) {
      const glm::dvec3 target(placement * glm::dvec4(unit(random), unit(random), 3, 1));
      const glm::vec3 origin(center + 40.0 * glm::dvec3(test::randomDirection(random)));
      rays.push_back({.origin = origin,
                      .direction = glm::vec3(glm::normalize(target - glm::dvec3(origin))),
                      .tMax = 3.402823466e38f});
    }
    uint32_t hits = 0;
    for (const StepResult& result : step(scene, rays)) {
      hits += result.first == 0;
      ASSERT_EQ(result.second, gpu::kInvalidIndex) << k;
      ASSERT_EQ(result.back, gpu::kInvalidIndex) << k;
    }
    EXPECT_GT(hits, 4900u);
  }
}
