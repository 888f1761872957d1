// The race of two pipelines, without a device.
#include <gtest/gtest.h>

#include "render/pipeline_choice.hpp"

namespace isophote {
namespace {

constexpr double kCompile = 100; // milliseconds
constexpr double kSubmit = 50;

/// Submits until the choice is settled, at most `limit`; returns how many.
int settle(PipelineChoice& choice, double fusedSpeed, double wavefrontSpeed, int limit = 1000) {
  int submits = 0;
  for (; submits < limit && !choice.isSettled(); ++submits) {
    const double speed = choice.next() == Pipeline::Fused ? fusedSpeed : wavefrontSpeed;
    choice.add(static_cast<uint64_t>(speed * kSubmit), kSubmit);
  }
  return submits;
}

TEST(PipelineChoice, KeepsWhatWasAskedFor) {
  for (const Pipeline asked : {Pipeline::Wavefront, Pipeline::Fused}) {
    PipelineChoice choice(asked, Pipeline::Wavefront, true, 0.05);
    EXPECT_TRUE(choice.isSettled());
    choice.add(0, 1e9);
    EXPECT_EQ(choice.next(), asked);
  }
}

TEST(PipelineChoice, SettlesOnTheFasterWhicheverItIs) {
  for (const Pipeline first : {Pipeline::Wavefront, Pipeline::Fused}) {
    for (const double fused : {900.0, 1100.0}) {
      PipelineChoice choice(Pipeline::Auto, first, true, 0.05);
      EXPECT_EQ(choice.next(), first);
      EXPECT_LT(settle(choice, fused, 1000), 1000);
      EXPECT_EQ(choice.next(), fused > 1000 ? Pipeline::Fused : Pipeline::Wavefront);
    }
  }
}

TEST(PipelineChoice, AFewSubmitsThatWaitedForAnotherProgramDecideNothing) {
  PipelineChoice choice(Pipeline::Auto, Pipeline::Wavefront, true, 0.05);
  for (int i = 0; i < 1000 && !choice.isSettled(); ++i) {
    const bool fused = choice.next() == Pipeline::Fused;
    const bool waited = fused && i % 10 < 2;
    choice.add(fused ? 11 : 10, waited ? 20 * kSubmit : kSubmit);
  }
  EXPECT_EQ(choice.next(), Pipeline::Fused);
}

TEST(PipelineChoice, CompilesTheRivalOnlyWhenThatIsASmallPartOfTheTime) {
  PipelineChoice choice(Pipeline::Auto, Pipeline::Wavefront, true, 0.05);
  choice.addCompilation(kCompile / 2);
  choice.add(1, kCompile / 2); // the first submit compiles
  int alone = 0;
  for (; choice.next() == Pipeline::Wavefront; ++alone) choice.add(1, kSubmit);
  EXPECT_EQ(alone, 40); // 2 seconds for a tenth
}

TEST(PipelineChoice, ARaceOfNoTimeEnds) {
  PipelineChoice choice(Pipeline::Auto, Pipeline::Wavefront, true, 0);
  for (int i = 0; i < 100; ++i) choice.add(0, 0);
  EXPECT_TRUE(choice.isSettled());
}

TEST(PipelineChoice, WithoutARaceAutoStaysWithTheFirst) {
  for (const Pipeline first : {Pipeline::Wavefront, Pipeline::Fused}) {
    const PipelineChoice choice(Pipeline::Auto, first, false, 0.05);
    EXPECT_TRUE(choice.isSettled());
    EXPECT_EQ(choice.next(), first);
  }
}

} // namespace
} // namespace isophote
