// Closed emitting boxes: every transport error shows as a wrong geometric series. Pixels share one expectation, so they
// are the replicates of the t-test; its power floor says the smallest bias seen.
#include <cmath>

#include <gtest/gtest.h>

#include "support/render.hpp"
#include "support/scenes.hpp"

namespace isophote {
namespace {

using namespace isophote::test;

constexpr uint32_t kSize = 16;

Image renderFurnace(float rho, uint32_t samples, const EstimatorSettings& estimator, uint32_t size = kSize) {
  return renderImage(boxFurnace(glm::vec3(1), glm::vec3(rho)), boxFurnaceCamera(), size, size, samples,
                     {.estimator = estimator});
}

struct FurnaceCase {
  SamplerKind sampler;
  LightSampling lightSampling;
  MisHeuristic heuristic;
};

std::string furnaceCaseName(const testing::TestParamInfo<FurnaceCase>& info) {
  const char* const samplers[] = {"Sobol", "Independent"};
  const char* const modes[] = {"Mis", "LightsOnly", "BsdfOnly"};
  const char* const heuristics[] = {"Balance", "Power"};
  return std::string(samplers[static_cast<size_t>(info.param.sampler)]) +
         modes[static_cast<size_t>(info.param.lightSampling)] + heuristics[static_cast<size_t>(info.param.heuristic)];
}

class FurnaceCases : public testing::TestWithParam<FurnaceCase> {};

TEST_P(FurnaceCases, Test16EmissiveBoxGivesTwoAndFive) {
  const auto& [sampler, lightSampling, heuristic] = GetParam();
  EstimatorSettings estimator{.sampler = sampler,
                              .filter = PixelFilter::Box,
                              .lightSampling = lightSampling,
                              .misHeuristic = heuristic,
                              .seed = 16};
  // Light sampling alone has no finite variance in a corner, where the lit wall comes arbitrarily near.
  const double power = lightSampling == LightSampling::LightsOnly ? 0.1 : 0.006;
  EXPECT_TRUE(pixelMeanIs(renderFurnace(0.5f, 2048, estimator), "G", 2, power));
  EXPECT_TRUE(pixelMeanIs(renderFurnace(0.8f, 2048, estimator), "G", 1 / (1 - double(0.8f)), 2 * power));
}

INSTANTIATE_TEST_SUITE_P(
    RenderFurnace, FurnaceCases,
    testing::Values(FurnaceCase{SamplerKind::Sobol, LightSampling::Mis, MisHeuristic::Power},
                    FurnaceCase{SamplerKind::Sobol, LightSampling::Mis, MisHeuristic::Balance},
                    FurnaceCase{SamplerKind::Sobol, LightSampling::LightsOnly, MisHeuristic::Power},
                    FurnaceCase{SamplerKind::Sobol, LightSampling::BsdfOnly, MisHeuristic::Power},
                    FurnaceCase{SamplerKind::Independent, LightSampling::Mis, MisHeuristic::Power},
                    FurnaceCase{SamplerKind::Independent, LightSampling::Mis, MisHeuristic::Balance},
                    FurnaceCase{SamplerKind::Independent, LightSampling::LightsOnly, MisHeuristic::Power},
                    FurnaceCase{SamplerKind::Independent, LightSampling::BsdfOnly, MisHeuristic::Power}),
    furnaceCaseName);

TEST(RenderFurnace, Test17DepthLimitCutsTheSeriesAtEightScatterings) {
  const EstimatorSettings estimator{
      .filter = PixelFilter::Box, .maxDepth = 8, .russianRoulette = RussianRoulette::Off, .seed = 17};
  EXPECT_TRUE(pixelMeanIs(renderFurnace(0.5f, 1024, estimator), "R", 1.99609375, 0.01));
}

TEST(RenderFurnace, Test17LosslessBoxGivesDepthPlusOneWithoutVariance) {
  // BSDF sampling without roulette: every path sums the same series, so the value is exact but for rounding.
  for (const uint32_t depth : {0u, 1u, 2u, 7u, 31u}) {
    const EstimatorSettings estimator{.filter = PixelFilter::Box,
                                      .lightSampling = LightSampling::BsdfOnly,
                                      .maxDepth = depth,
                                      .russianRoulette = RussianRoulette::Off,
                                      .seed = 17};
    const Image image = renderFurnace(1, 16, estimator);
    for (const char* channel : {"R", "G", "B"}) {
      for (const float value : plane(image, channel)) ASSERT_NEAR(value, depth + 1.0, 1e-6 * (depth + 1.0));
      for (const float error : plane(image, std::string("stderr.") + channel)) ASSERT_LT(error, 1e-6 * (depth + 1.0));
    }
  }
}

TEST(RenderFurnace, Test18RouletteKeepsTheSeriesOfADarkeningByOnePercent) {
  // rho = 0.99: a hundred bounces on average, most of the light behind roulette. BSDF sampling: one path's relative
  // deviation is about 1. Roulette that survives less often than rho squared would have no finite variance here.
  const EstimatorSettings estimator{.filter = PixelFilter::Box, .lightSampling = LightSampling::BsdfOnly, .seed = 18};
  EXPECT_TRUE(pixelMeanIs(renderFurnace(0.99f, 512, estimator), "B", 1 / (1 - double(0.99f)), 0.02));
}

// The same to 0.3%, by 3 million paths of a hundred bounces.
TEST(RenderFurnace, Test18RouletteKeepsTheSeriesOfADarkeningByOnePercentSlow) {
  const EstimatorSettings estimator{.filter = PixelFilter::Box, .lightSampling = LightSampling::BsdfOnly, .seed = 118};
  EXPECT_TRUE(pixelMeanIs(renderFurnace(0.99f, 768, estimator, 64), "B", 1 / (1 - double(0.99f)), 0.003));
}

TEST(RenderFurnace, RouletteDoesNotChangeADepthLimitedSeries) {
  for (const RussianRoulette roulette : {RussianRoulette::Off, RussianRoulette::Root, RussianRoulette::Throughput}) {
    const EstimatorSettings estimator{
        .filter = PixelFilter::Box, .maxDepth = 6, .russianRoulette = roulette, .seed = 3};
    EXPECT_TRUE(pixelMeanIs(renderFurnace(0.7f, 1024, estimator), "R", (1 - std::pow(0.7, 7)) / 0.3, 0.012));
  }
}

TEST(RenderFurnace, ChannelsKeepTheirOwnAlbedo) {
  const Image image = renderImage(boxFurnace({1, 2, 4}, {0.25f, 0.5f, 0.75f}), boxFurnaceCamera(), kSize, kSize, 1024);
  EXPECT_TRUE(pixelMeanIs(image, "R", 4.0 / 3, 0.01));
  EXPECT_TRUE(pixelMeanIs(image, "G", 4, 0.01));
  EXPECT_TRUE(pixelMeanIs(image, "B", 16, 0.02));
}

} // namespace
} // namespace isophote
