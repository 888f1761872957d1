// Each wavefront stage alone, on queues made by hand.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

#include <gtest/gtest.h>

#include "kernel/stage.hpp"
#include "upload/camera_record.hpp"
#include "upload/filter_table.hpp"

namespace isophote::test {
namespace {

// A unit square at z = 0, facing +z, alone in the dark.
Scene squareScene() {
  Scene scene;
  scene.materials.push_back({});
  Primitive square;
  square.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  square.indices = {0, 1, 2, 0, 2, 3};
  scene.meshes.push_back({"square", {square}});
  scene.instances.push_back({});
  return scene;
}

uint32_t groupsFor(uint32_t count) { return (count + Stage::kWorkgroup - 1) / Stage::kWorkgroup; }

void fillQueue(Stage& stage, uint32_t queue, uint32_t count) {
  std::iota(stage.queues[queue].begin(), stage.queues[queue].begin() + count, 0u);
  stage.wave.counts[queue] = count;
}

TEST(Prepare, StartsNoMoreSamplesThanSlotsLimitAndWorkAllow) {
  Stage stage(squareScene(), 1000);
  struct Case {
    uint32_t freeCount, limit;
    uint64_t workLeft;
    uint32_t expected;
  };
  for (const Case& c : {Case{1000, 5000, 5000, 1000}, Case{1000, 300, 5000, 300}, Case{1000, 5000, 7, 7},
                        Case{400, 700, 5000, 100}, Case{400, 500, 5000, 0}, Case{0, 5000, 5000, 0}}) {
    stage.wave = {};
    stage.wave.counts[gpu::kQueueFree] = c.freeCount;
    stage.wave.nextWork = 16 * 10 + 3;
    stage.view.workEnd = stage.wave.nextWork + c.workLeft;
    stage.activeLimit = c.limit;
    stage.run(stage.kernels.prepare, 1, gpu::kPrepareRegenerate);
    EXPECT_EQ(stage.wave.regenerateCount, c.expected);
    EXPECT_EQ(stage.wave.counts[gpu::kQueueFree], c.freeCount - c.expected);
    EXPECT_EQ(stage.wave.regenerateSample, 10u);
    EXPECT_EQ(stage.wave.regeneratePixel, 3u);
    EXPECT_EQ(stage.wave.nextWork, 163u + c.expected);
    EXPECT_EQ(stage.wave.dispatches[gpu::kStageRegenerate].x, groupsFor(c.expected));
  }
}

TEST(Prepare, CountsRaysByKindAndSizesDispatches) {
  Stage stage(squareScene(), 1000);
  stage.wave.counts[gpu::kQueueRay] = 130;
  stage.run(stage.kernels.prepare, 1, gpu::kPrepareRegenerate);
  stage.wave.counts[gpu::kQueueRay] = 200; // as if regenerate had added 70
  stage.run(stage.kernels.prepare, 1, gpu::kPrepareIntersect);
  EXPECT_EQ(stage.wave.bounceRays, 130u);
  EXPECT_EQ(stage.wave.primaryRays, 70u);
  EXPECT_EQ(stage.wave.dispatches[gpu::kStageIntersectClosest].x, groupsFor(200));
  stage.wave.counts[gpu::kQueueSurface] = 64;
  stage.wave.counts[gpu::kQueueEscaped] = 65;
  stage.wave.counts[gpu::kQueueMedium] = 129;
  stage.run(stage.kernels.prepare, 1, gpu::kPrepareMedium); // the first stage that shades, in these kernels
  EXPECT_EQ(stage.wave.counts[gpu::kQueueRay], 0u);
  EXPECT_EQ(stage.wave.dispatches[gpu::kStageShadeMedium].x, 3u);
  stage.run(stage.kernels.prepare, 1, gpu::kPrepareShade);
  EXPECT_EQ(stage.wave.dispatches[gpu::kStageShadeSurface].x, 1u);
  EXPECT_EQ(stage.wave.dispatches[gpu::kStageShadeEscaped].x, 2u);
}

TEST(Regenerate, StartsEachPixelSampleOnceAndParksPadding) {
  // 5 x 3 pixels in tiles of 4 x 2: 8 x 4 padded, 17 of 32 work items fall outside.
  Stage stage(squareScene(), 200, {.width = 5, .height = 3});
  stage.view.tileSize = {4, 2};
  stage.view.tileColumns = 2;
  stage.view.paddedPixelCount = 32;
  stage.view.firstSample = 40;
  stage.view.camera = cameraRecord({}, 5, 3, {});
  const std::vector<float> box = filterTable(PixelFilter::Box);
  gpu::writeBuffer(gpuDevice(), stage.pool.filterTable, 0, std::as_bytes(std::span(box)));
  const uint32_t items = 96; // three samples of every padded pixel
  std::iota(stage.queues[gpu::kQueueFree].begin(), stage.queues[gpu::kQueueFree].end(), 0u);
  stage.wave.counts[gpu::kQueueFree] = 200 - items;
  stage.wave.regenerateCount = items;
  stage.run(stage.kernels.wavefront->regenerate, groupsFor(items));
  ASSERT_EQ(stage.wave.counts[gpu::kQueueRay], 45u);
  ASSERT_EQ(stage.wave.counts[gpu::kQueueFinished], 51u);
  std::set<std::pair<uint32_t, uint32_t>> started;
  std::set<uint32_t> slots;
  for (uint32_t i = 0; i < 45; ++i) {
    const uint32_t slot = stage.queues[gpu::kQueueRay][i];
    EXPECT_GE(slot, 200 - items);
    slots.insert(slot);
    started.emplace(stage.paths[slot].pixel, stage.paths[slot].sampleIndex);
    EXPECT_NEAR(glm::length(stage.rays[slot].direction), 1.0, 1e-6);
  }
  EXPECT_EQ(slots.size(), 45u);
  for (uint32_t y = 0; y < 3; ++y) {
    for (uint32_t x = 0; x < 5; ++x) {
      for (uint32_t s = 40; s < 43; ++s) EXPECT_EQ(started.count({x | y << 16, s}), 1u);
    }
  }
  for (uint32_t i = 0; i < 51; ++i) {
    EXPECT_EQ(stage.paths[stage.queues[gpu::kQueueFinished][i]].sampleIndex, gpu::kNoSample);
  }
}

TEST(IntersectClosest, SendsHitsToSurfacesAndMissesOutside) {
  Stage stage(squareScene(), 300);
  fillQueue(stage, gpu::kQueueRay, 300);
  for (uint32_t i = 0; i < 300; ++i) {
    const float x = -1.5f + 0.01f * static_cast<float>(i) + 0.003f;
    stage.rays[i] = {{x, 0.25f, 2}, 0, {0, 0, -1}, gpu::kRayInfinity};
  }
  stage.run(stage.kernels.wavefront->intersectClosest, groupsFor(300));
  EXPECT_EQ(stage.wave.counts[gpu::kQueueSurface] + stage.wave.counts[gpu::kQueueEscaped], 300u);
  EXPECT_EQ(stage.wave.counts[gpu::kQueueSurface], 200u);
  for (uint32_t i = 0; i < stage.wave.counts[gpu::kQueueSurface]; ++i) {
    EXPECT_LT(std::abs(stage.rays[stage.queues[gpu::kQueueSurface][i]].origin.x), 1.0f);
  }
}

TEST(IntersectShadow, AddsTheContributionOnlyWhereTheLightIsSeen) {
  Stage stage(squareScene(), 64);
  fillQueue(stage, gpu::kQueueShadow, 64);
  for (uint32_t i = 0; i < 64; ++i) {
    const bool blocked = i % 3 == 0;
    stage.shadows[i] = {{0.1f, 0.2f, 1}, 1.0f, {0, 0, blocked ? -2.0f : -0.9f}, 0, {1, 2, 3}};
    stage.paths[i].radiance = {0.5f, 0, 0};
  }
  stage.run(stage.kernels.wavefront->intersectShadow.value(), 1);
  for (uint32_t i = 0; i < 64; ++i) {
    EXPECT_EQ(stage.paths[i].radiance.z, i % 3 == 0 ? 0.0f : 3.0f) << i;
    EXPECT_EQ(stage.paths[i].radiance.x, i % 3 == 0 ? 0.5f : 1.5f) << i;
  }
}

TEST(Accumulate, FreesSlotsAndCountsWhatItRefuses) {
  Stage stage(squareScene(), 8);
  fillQueue(stage, gpu::kQueueFinished, 8);
  for (uint32_t i = 0; i < 8; ++i) {
    stage.paths[i] = {};
    stage.paths[i].sampleIndex = i;
    stage.paths[i].radiance = {1, 1, 1};
  }
  const float infinity = std::numeric_limits<float>::infinity();
  stage.paths[1].radiance.y = std::numeric_limits<float>::quiet_NaN();
  stage.paths[2].radiance.z = infinity;
  stage.paths[3].radiance.x = -infinity;
  stage.paths[4].radiance.x = -1e-20f;
  stage.paths[5].radiance.x = 1e9f; // beyond 2^26 of the unit emitter scale
  stage.paths[6].sampleIndex = gpu::kNoSample;
  stage.paths[7].hit = 1;
  stage.run(stage.kernels.wavefront->accumulate, 1);
  EXPECT_EQ(stage.wave.counts[gpu::kQueueFree], 8u);
  EXPECT_EQ(stage.wave.status[gpu::kStatusNonFinite], 3u);
  EXPECT_EQ(stage.wave.status[gpu::kStatusNegative], 1u);
  EXPECT_EQ(stage.wave.status[gpu::kStatusClipped], 1u);
  const auto sums = stage.filmSums();
  const int64_t one = int64_t{1} << gpu::kRadianceFractionBits;
  const int64_t red[8] = {one, 0, 0, 0, 0, int64_t{1} << 62, 0, one};
  for (uint32_t r = 0; r < 8; ++r) {
    EXPECT_EQ(sums[r].red, red[r]) << r;
    EXPECT_EQ(sums[r].count, r == 6 ? 0u : 1u) << r;
    EXPECT_EQ(sums[r].hitCount, r == 7 ? 1u : 0u) << r;
  }
}

// The image is wrong then, and says so.
TEST(Accumulate, SumsThatLeaveSixtyThreeBitsAreCounted) {
  Stage stage(squareScene(), 5);
  fillQueue(stage, gpu::kQueueFinished, 5);
  for (uint32_t i = 0; i < 5; ++i) {
    stage.paths[i] = {};
    stage.paths[i].sampleIndex = 8 * i;        // one replicate
    stage.paths[i].radiance = {1, 0x1p25f, 0}; // 2^61 units of green
  }
  stage.run(stage.kernels.wavefront->accumulate, 1);
  EXPECT_EQ(stage.wave.status[gpu::kStatusClipped], 2u); // the fourth sample and the fifth
}

// Test 51 of the reference list: a constant comes out as itself after 1e8 samples.
TEST(Accumulate, T51ConstantsSurviveAHundredMillionSamples) {
  constexpr uint32_t kSlots = 1u << 20;
  constexpr uint32_t kRepeats = 96;
  Stage stage(squareScene(), kSlots);
  fillQueue(stage, gpu::kQueueFinished, kSlots);
  for (uint32_t i = 0; i < kSlots; ++i) {
    stage.paths[i] = {};
    stage.paths[i].pixel = (i / 8) % 4 | ((i / 32) % 4) << 16;
    stage.paths[i].sampleIndex = i;
    stage.paths[i].radiance = {0.5f, 0.1f, 1e-9f};
  }
  // The free queue overflows after the first pass: that is counted, and harmless here.
  stage.run(stage.kernels.wavefront->accumulate, groupsFor(kSlots), 0, kRepeats);
  double count = 0;
  double red = 0;
  double green = 0;
  double blue = 0;
  for (const gpu::ReplicateSum& sum : stage.filmSums()) {
    count += sum.count;
    red += static_cast<double>(sum.red);
    green += static_cast<double>(sum.green);
    blue += static_cast<double>(sum.blue);
  }
  const double unit = std::ldexp(1.0, -static_cast<int>(gpu::kRadianceFractionBits));
  EXPECT_EQ(count, double{kSlots} * kRepeats);
  EXPECT_EQ(red * unit / count, 0.5);
  EXPECT_NEAR(green * unit / count, 0.1f, 1e-9);
  // 68.7 units: rounding to whole units would be off by 0.4%, stochastic rounding is not.
  EXPECT_NEAR(blue * unit / count / 1e-9, 1.0, 3e-5); // 4.6 standard deviations of the rounding of 2^20 samples
}

TEST(Queues, APushBeyondCapacityIsCountedAndWritesNothing) {
  Stage stage(squareScene(), 64);
  fillQueue(stage, gpu::kQueueFinished, 64);
  for (auto& path : stage.paths) path.sampleIndex = gpu::kNoSample;
  stage.wave.counts[gpu::kQueueFree] = 40;
  stage.run(stage.kernels.wavefront->accumulate, 1);
  EXPECT_EQ(stage.wave.status[gpu::kStatusQueueOverflow], 40u);
}

} // namespace
} // namespace isophote::test
