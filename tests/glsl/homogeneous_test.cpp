#include "glsl/homogeneous_case.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "support/probe.hpp"
#include "support/statistics.hpp"
#include "test_glsl_kernels.hpp"

namespace isophote {
namespace {

using gpu::HomogeneousCase;
using gpu::HomogeneousResult;

std::vector<HomogeneousResult> run(const std::vector<HomogeneousCase>& cases) {
  return test::runProbe<HomogeneousCase, HomogeneousResult>(test_glsl_kernels::kernelSource("homogeneous_probe"),
                                                            cases);
}

TEST(Homogeneous, TransmittanceMatchesBeerAndLambertFromOpticalDepth1em8To1e4) {
  std::vector<HomogeneousCase> cases;
  for (int i = 0; i <= 2400; ++i) {
    const auto depth = static_cast<float>(std::pow(10.0, -8 + i * 0.005));
    cases.push_back({{depth, depth * 2, 0}, 1, {}, glm::vec3(1), {0, 0}});
    cases.push_back({{1e-3f, 1e3f, 0}, depth * 1e3f, {}, glm::vec3(1), {0, 0}});
  }
  const auto results = run(cases);
  for (size_t i = 0; i < cases.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const double depth = double(cases[i].extinction[c]) * double(cases[i].limit);
      // The product is rounded by 2^-24, which exp turns into an absolute error of the depth; 4 ULP of exp.
      const double tolerance = std::exp(-depth) * (2.5e-7 + depth * 2.5e-7) + 1.2e-38;
      ASSERT_NEAR(results[i].transmittance[c], std::exp(-depth), tolerance) << depth;
    }
  }
}

TEST(Homogeneous, OpticalDepthIsTheLogarithmAtBothEnds) {
  std::vector<HomogeneousCase> cases;
  std::mt19937 generator(5);
  for (uint32_t i = 0; i < 1000; ++i) {
    const uint32_t any = static_cast<uint32_t>(generator());
    for (const uint32_t bits : {i, ~i, any, any >> (i % 32), ~(any >> (i % 32)), 0xbfffff00u + i / 2})
      cases.push_back({glm::vec3(1), 1, {}, glm::vec3(1), {0, bits}});
  }
  const auto results = run(cases);
  for (size_t i = 0; i < cases.size(); ++i) {
    const double rest = (4294967295.0 - cases[i].bits.y + 0.5) / 4294967296.0;
    const double expected = -std::log1p(-rest);
    ASSERT_NEAR(results[i].opticalDepth / expected, 1, 2e-6) << cases[i].bits.y;
  }
}

// The estimator's expectation in each channel, by quadrature over the optical depth and exact sums over the channels:
// both the share that passes and the share scattered must be Beer and Lambert's.
TEST(Homogeneous, ChromaticDistanceSamplingIsUnbiased) {
  struct Setup {
    glm::vec3 extinction, beta;
    float limit;
  };
  const Setup setups[] = {{{1, 1, 1}, {1, 1, 1}, 1},
                          {{0.1f, 1, 10}, {1, 1, 1}, 0.7f},
                          {{0, 2, 50}, {0.2f, 1, 0.01f}, 1},
                          {{1e-3f, 1e-2f, 0}, {3, 2, 1}, 5},
                          {{5, 0.5f, 0.05f}, {1, 0, 1}, 2}};
  constexpr uint32_t kChoices = 64, kDepths = 8192;
  std::mt19937 generator(6);
  for (const Setup& setup : setups) {
    std::vector<HomogeneousCase> cases;
    for (uint32_t i = 0; i < kChoices; ++i) {
      for (uint32_t j = 0; j < kDepths; ++j) {
        const uint32_t within = static_cast<uint32_t>(generator());
        cases.push_back({setup.extinction,
                         setup.limit,
                         glm::vec3(0.5f),
                         setup.beta,
                         {i * (0xffffffffu / kChoices) + (within & 0x3ffffffu), j * (0xffffffffu / kDepths)}});
      }
    }
    glm::dvec3 passed(0), scattered(0);
    const double sum = double(setup.beta.x) + setup.beta.y + setup.beta.z;
    for (const auto& result : run(cases)) {
      (result.scattered != 0 ? scattered : passed) += glm::dvec3(result.weight) / static_cast<double>(cases.size());
      // No channel of the throughput exceeds the former sum, and a scattering keeps the albedo's share at most.
      for (int c = 0; c < 3; ++c)
        ASSERT_LE(result.weight[c] * setup.beta[c], sum * 1.00001 * (result.scattered != 0 ? 0.5 : 1.0));
      ASSERT_TRUE(result.distance >= 0 && result.distance <= setup.limit);
    }
    for (int c = 0; c < 3; ++c) {
      if (setup.beta[c] == 0) continue;
      const double left = std::exp(-double(setup.extinction[c]) * setup.limit);
      const double noise = 0.005 * sum / setup.beta[c]; // stratified in 64 x 8192 cells
      EXPECT_NEAR(passed[c], left, noise * std::max(left, 0.05)) << c;
      EXPECT_NEAR(scattered[c], 0.5 * (1 - left), noise * std::max(1 - left, 0.05)) << c;
    }
  }
}

// Gray: the distance must be exponential. 64 equally likely bins, 1562 expected in each.
TEST(Homogeneous, DistancesFollowTheExponentialByChiSquare) {
  constexpr uint32_t kSamples = 100'000;
  std::mt19937 generator(7);
  for (const float extinction : {1e-6f, 1.0f, 1e9f}) {
    std::vector<HomogeneousCase> cases(kSamples);
    for (auto& c : cases)
      c = {glm::vec3(extinction),
           1e30f,
           glm::vec3(1),
           glm::vec3(1),
           {static_cast<uint32_t>(generator()), static_cast<uint32_t>(generator())}};
    std::vector<uint64_t> counts(64);
    for (const auto& result : run(cases)) {
      ASSERT_EQ(result.scattered, 1u);
      ASSERT_NEAR(result.weight.x, 1, 1e-6);
      const double cdf = -std::expm1(-double(result.distance) * double(extinction));
      ++counts[std::min<size_t>(static_cast<size_t>(cdf * 64), 63)];
    }
    const std::vector<double> expected(64, kSamples / 64.0);
    EXPECT_GT(test::chiSquareTest(counts, expected).p, test::sidak(0.001, 3)) << extinction;
  }
}

} // namespace
} // namespace isophote
