// What a render of the Cornell box costs apart from time: code, rays, memory. Grown figures want a reason.
#include <gtest/gtest.h>

#include <map>

#include "isophote/path_tracer.hpp"
#include "shared/path_types.h"
#include "support/gpu_device.hpp"
#include "support/render.hpp"
#include "support/scenes.hpp"

namespace isophote {
namespace {

// Compilers of other versions emit a little more or less.
constexpr double kMargin = 1.03;

RenderStatistics costOfCornellBox(Pipeline pipeline) {
  const Device& device = test::gpuDevice();
  const GpuScene scene(device, test::cornellBox());
  Film film(device, {.width = 32, .height = 32, .aovs = false});
  PathTracer tracer(device, scene, {.maxDepth = 8, .seed = 1}, {.pipeline = pipeline});
  tracer.render(test::cornellCamera(), film, {0, 16});
  test::expectHealthy(tracer.statistics());
  return tracer.statistics();
}

TEST(RenderCost, KernelsOfADiffuseSceneAreNoLargerThanRecorded) {
  // A feature that this scene lacks adds no code to it.
  using Bytes = std::map<std::string, uint32_t>;
  const std::map<Pipeline, Bytes> recorded{{Pipeline::Wavefront,
                                            {{"prepare", 9096},
                                             {"regenerate", 22988},
                                             {"intersect_closest", 62772},
                                             {"shade_surface", 138160},
                                             {"intersect_shadow", 64556},
                                             {"accumulate", 14824}}},
                                           {Pipeline::Fused, {{"prepare", 9096}, {"fused", 138160}}}};
  for (const auto& [pipeline, bytes] : recorded) {
    const RenderStatistics cost = costOfCornellBox(pipeline);
    EXPECT_EQ(cost.kernels.size(), bytes.size());
    for (const KernelStatistics& kernel : cost.kernels) {
      ASSERT_TRUE(bytes.contains(kernel.name)) << kernel.name;
      EXPECT_LE(kernel.spirvBytes, kMargin * bytes.at(kernel.name)) << kernel.name;
    }
  }
}

TEST(RenderCost, RaysAndBytesOfAPathAreNoMoreThanRecorded) {
  const RenderStatistics cost = costOfCornellBox(Pipeline::Fused);
  EXPECT_LE(cost.bytesPerPath, 160u);
  EXPECT_EQ(cost.primaryRays, 32u * 32u * 16u);
  const double samples = 32.0 * 32.0 * 16.0;
  EXPECT_NEAR(static_cast<double>(cost.bounceRays) / samples, 2.184, 0.02);
  EXPECT_NEAR(static_cast<double>(cost.shadowRays) / samples, 1.868, 0.02);
}

TEST(RenderCost, ABounceMovesNoMoreBytesThanRecorded) {
  // With next event estimation: each of these is written by one kernel and read by another.
  const size_t passedOn = sizeof(gpu::RayState) + sizeof(gpu::HitState) + sizeof(gpu::PathState) +
                          sizeof(gpu::ShadowState) + sizeof(gpu::PathState::radiance) +
                          3 * sizeof(uint32_t); // entries of the queues of rays, surfaces and shadow rays
  EXPECT_LE(2 * passedOn, 320u);
}

} // namespace
} // namespace isophote
