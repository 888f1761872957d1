// Work per submit against the times of submits, without a device.
#include <gtest/gtest.h>

#include "render/work_size.hpp"

namespace isophote {
namespace {

constexpr double kWanted = 100; // milliseconds

TEST(WorkSize, FindsTheSubmitThatLastsAsLongAsWasAsked) {
  for (const Pipeline pipeline : {Pipeline::Wavefront, Pipeline::Fused}) {
    WorkSize work(kWanted);
    work.setCapacity(1 << 15);
    const auto units = [&] { return pipeline == Pipeline::Fused ? work.steps() : work.waves(); };
    for (int i = 0; i < 20; ++i) work.follow(pipeline, 5.0 * units(), 5, true);
    EXPECT_EQ(units(), 20u);
    EXPECT_EQ(work.activeLimit(), 1u << 15);
  }
}

TEST(WorkSize, ALongDispatchMakesTheWaveSmallerAndAShortOneLargerAgain) {
  WorkSize work(kWanted);
  work.setCapacity(1 << 15);
  work.follow(Pipeline::Wavefront, 400, 400, true);
  EXPECT_EQ(work.activeLimit(), 1u << 13);
  for (int i = 0; i < 20; ++i) work.follow(Pipeline::Wavefront, kWanted, 10, true);
  EXPECT_EQ(work.activeLimit(), 1u << 15);
}

// One dispatch is a whole submit of the fused kernel: it gets fewer steps before it gets fewer paths.
TEST(WorkSize, ALongDispatchOfTheFusedKernelGetsFewerSteps) {
  WorkSize work(kWanted);
  work.setCapacity(1 << 15);
  for (int i = 0; i < 3; ++i) work.follow(Pipeline::Fused, 10, 10, true);
  EXPECT_EQ(work.steps(), 8u);
  work.follow(Pipeline::Fused, 400, 400, true);
  EXPECT_EQ(work.steps(), 2u);
  EXPECT_EQ(work.activeLimit(), 1u << 15);
}

// The first dispatch may compile.
TEST(WorkSize, OneLongDispatchOfTheFusedKernelDoesNotKeepItsPoolSmall) {
  WorkSize work(kWanted);
  work.setCapacity(1 << 15);
  work.follow(Pipeline::Fused, 2000, 2000, true);
  EXPECT_EQ(work.activeLimit(), 1u << 13);
  for (int i = 0; i < 12; ++i) {
    const double milliseconds = 20.0 * work.steps() * work.activeLimit() / (1 << 15);
    work.follow(Pipeline::Fused, milliseconds, milliseconds, true);
  }
  EXPECT_EQ(work.activeLimit(), 1u << 15);
  EXPECT_EQ(work.steps(), 5u);
}

TEST(WorkSize, TheStepsOfARendersEndDoNotBeginTheNext) {
  WorkSize work(kWanted);
  work.setCapacity(1 << 15);
  work.follow(Pipeline::Fused, 50, 50, true);
  for (int i = 0; i < 8; ++i) work.follow(Pipeline::Fused, 1, 1, false); // few paths are left: steps are cheap
  EXPECT_GT(work.steps(), 100u);
  work.beginRender();
  EXPECT_EQ(work.steps(), 2u);
}

} // namespace
} // namespace isophote
