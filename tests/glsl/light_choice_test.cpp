#include "glsl/light_choice_case.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "glsl/light_scene.hpp"
#include "support/probe.hpp"
#include "support/statistics.hpp"
#include "test_glsl_kernels.hpp"

namespace isophote {
namespace {

using gpu::LightChoiceCase;
using gpu::LightChoiceResult;

std::vector<LightChoiceResult> run(const std::vector<double>& powers, const std::vector<LightChoiceCase>& cases) {
  test::LightScene scene;
  scene.powers = powers;
  return test::runProbe<LightChoiceCase, LightChoiceResult>(test_glsl_kernels::kernelSource("light_choice_probe"),
                                                            cases, scene.address());
}

std::vector<LightChoiceCase> randomBits(uint32_t count) {
  std::mt19937 generator(54);
  std::vector<LightChoiceCase> cases(count);
  for (auto& c : cases) c.bits = {static_cast<uint32_t>(generator()), static_cast<uint32_t>(generator())};
  return cases;
}

std::vector<double> manyLights(size_t count, double dominant) {
  std::mt19937 generator(5);
  std::exponential_distribution<double> power;
  std::vector<double> powers(count);
  for (double& p : powers) p = generator() % 10 == 0 ? 0 : power(generator);
  powers[count / 3] = dominant;
  return powers;
}

// 1e6 choices. 1000 lights: a light 15% off, or half of them 1% off. With one light a million times the others nearly
// all choices are that light, and the others together appear as often as they should.
TEST(LightChoice, FollowsThePowersByChiSquare) {
  const auto cases = randomBits(1'000'000);
  const std::vector<double> scenes[] = {manyLights(1000, 1), manyLights(100'000, 1), manyLights(1000, 1e6), {3}};
  for (const auto& powers : scenes) {
    double total = 0;
    for (const double p : powers) total += p;
    std::vector<uint64_t> counts(powers.size());
    for (const auto& result : run(powers, cases)) {
      ASSERT_LT(result.index, powers.size());
      ++counts[result.index];
      ASSERT_NEAR(result.pmf / (powers[result.index] / total), 1, 1e-6);
    }
    if (powers.size() == 1) continue; // nothing to test but the index
    std::vector<double> expected;
    for (const double p : powers) expected.push_back(p / total * static_cast<double>(cases.size()));
    const auto chi = test::chiSquareTest(counts, expected);
    EXPECT_GT(chi.p, test::sidak(0.001, 3)) << powers.size();
    EXPECT_EQ(chi.stray, 0) << "a light without power was chosen";
  }
}

// A share of 1e-12 is below the 2^-32 that one 32-bit number resolves; the fraction of the bin's number decides.
TEST(LightChoice, ThresholdsBelow2ToMinus32AreMet) {
  const double t = 2e-12 * std::ldexp(1.0, 64); // two bins: light 1 keeps its bin below this fraction
  const auto bits = [](double fraction) { return 0x80000000u + static_cast<uint32_t>(fraction / 2); };
  const auto results = run({1, 1e-12}, {{{bits(0.9 * t), 0}}, {{bits(1.1 * t), 0}}, {{bits(0), 1}}});
  EXPECT_EQ(results[0].index, 1u);
  EXPECT_EQ(results[1].index, 0u);
  EXPECT_EQ(results[2].index, 0u);
}

TEST(LightChoice, ExtremeBitsChooseAnExistingLightWithPower) {
  const uint32_t values[] = {0, 1, 0x7fffffff, 0x80000000, 0xfffffffe, 0xffffffff};
  std::vector<LightChoiceCase> cases;
  for (const uint32_t x : values) {
    for (const uint32_t y : values) cases.push_back({{x, y}});
  }
  for (const auto& result : run({0, 2, 0, 5, 0}, cases)) {
    EXPECT_TRUE(result.index == 1 || result.index == 3);
    EXPECT_GT(result.pmf, 0);
  }
}

} // namespace
} // namespace isophote
