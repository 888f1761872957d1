#include "glsl/henyey_greenstein_case.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "oracle/medium.hpp"
#include "support/probe.hpp"
#include "support/statistics.hpp"
#include "test_glsl_kernels.hpp"

namespace isophote {
namespace {

using gpu::HenyeyGreensteinCase;
using gpu::HenyeyGreensteinResult;

constexpr float kAnisotropies[] = {0, 1e-7f, -1e-4f, 1e-3f, 0.1f, -0.5f, 0.9f, -0.99f, 0.999f, -0.999f};

std::vector<HenyeyGreensteinResult> run(const std::vector<HenyeyGreensteinCase>& cases) {
  return test::runProbe<HenyeyGreensteinCase, HenyeyGreensteinResult>(
      test_glsl_kernels::kernelSource("henyey_greenstein_probe"), cases);
}

glm::vec3 randomDirection(std::mt19937& generator) {
  std::normal_distribution<double> normal;
  return glm::vec3(glm::normalize(glm::dvec3(normal(generator), normal(generator), normal(generator))));
}

float lattice(std::mt19937& generator) {
  return std::ldexp(static_cast<float>(static_cast<uint32_t>(generator()) >> 8), -24);
}

TEST(HenyeyGreenstein, ValuesMatchTheOracle) {
  std::mt19937 generator(11);
  std::vector<HenyeyGreensteinCase> cases;
  for (const float g : kAnisotropies) {
    for (int i = 0; i < 2000; ++i) {
      const glm::vec3 wo = randomDirection(generator);
      // Half of them near the peaks, at angles down to 1e-4.
      const double angle = std::pow(10, -4.0 * (i % 100) / 100);
      const glm::dvec3 near = glm::dvec3(i % 4 == 0 ? wo : -wo) + angle * glm::dvec3(randomDirection(generator));
      cases.push_back({wo, g, i % 2 == 0 ? glm::vec3(glm::normalize(near)) : randomDirection(generator), {0, 0}});
    }
  }
  const auto results = run(cases);
  for (size_t i = 0; i < cases.size(); ++i) {
    const auto& c = cases[i];
    // The angle between two rounded unit vectors, by their difference: acos of a dot product would lose it.
    const glm::dvec3 wo = glm::normalize(glm::dvec3(c.wo));
    const glm::dvec3 wi = glm::normalize(glm::dvec3(c.wi));
    const double g = c.g;
    const double sharp = 1 - std::abs(g);
    const double apart = glm::length(g >= 0 ? wi + wo : wi - wo);
    const double base = sharp * sharp + std::abs(g) * apart * apart;
    const double expected = (1 - g * g) / (4 * std::numbers::pi * std::pow(base, 1.5));
    if (apart > 1e-2) {
      EXPECT_NEAR(expected / oracle::henyeyGreenstein(-glm::dot(wo, wi), g), 1, 1e-9);
    }
    // Unit vectors are rounded by up to 1e-7: d(base)/base <= 2 |g| apart 1.5e-7 / base, and 1.5 times that in p.
    const double tolerance = 1e-6 + 1.5 * 2 * std::abs(g) * (apart + 1e-7) * 1.5e-7 / base;
    ASSERT_NEAR(results[i].value / expected, 1, tolerance) << "g " << g << " apart " << apart;
  }
}

// 64 bins of the cosine equally likely by the oracle's distribution, by 8 of the azimuth; 390 expected in each.
TEST(HenyeyGreenstein, SamplesFollowTheDensityByChiSquare) {
  constexpr uint32_t kSamples = 200'000;
  std::mt19937 generator(12);
  for (const float g : kAnisotropies) {
    const glm::vec3 wo = randomDirection(generator);
    const glm::dvec3 forward = -glm::normalize(glm::dvec3(wo));
    const glm::dvec3 side = glm::normalize(glm::cross(forward, glm::dvec3(0.3, 0.5, 0.8)));
    std::vector<double> edges;
    for (int i = 1; i < 64; ++i) edges.push_back(1 - oracle::sampleHenyeyGreensteinCosine(std::abs(g), 1 - i / 64.0));
    // By the distance from the peak, ascending; a negative g is a positive one turned round.
    const glm::dvec3 peak = g < 0 ? -forward : forward;
    std::vector<HenyeyGreensteinCase> cases(kSamples);
    for (auto& c : cases) c = {wo, g, wo, {lattice(generator), lattice(generator)}};
    std::vector<uint64_t> counts(64 * 8);
    double mean = 0;
    for (const auto& result : run(cases)) {
      const glm::dvec3 wi(result.sampled);
      ASSERT_NEAR(glm::length(wi), 1, 1e-6);
      const double apart = glm::length(wi - peak);
      const double oneMinusCos = 0.5 * apart * apart;
      mean += (1 - oneMinusCos) / kSamples;
      const auto bin = static_cast<size_t>(std::upper_bound(edges.begin(), edges.end(), oneMinusCos) - edges.begin());
      const double turn = std::atan2(glm::dot(wi, glm::cross(forward, side)), glm::dot(wi, side)) / std::numbers::pi;
      ++counts[bin * 8 + std::min<size_t>(static_cast<size_t>((turn + 1) * 4), 7)];
      ASSERT_TRUE(std::isfinite(result.sampledValue) && result.sampledValue > 0);
    }
    const std::vector<double> expected(counts.size(), kSamples / 512.0);
    EXPECT_GT(test::chiSquareTest(counts, expected).p, test::sidak(0.001, std::size(kAnisotropies))) << g;
    EXPECT_NEAR(mean, std::abs(g), 5 / std::sqrt(3.0 * kSamples)) << "the mean cosine";
  }
}

// Samples from the uniform sphere weigh f in; its mean times 4 pi is the mass. Only where the peak is broad enough.
TEST(HenyeyGreenstein, DensityIntegratesToOne) {
  std::mt19937 generator(13);
  for (const float g : {0.0f, 1e-4f, 0.5f, -0.7f}) {
    std::vector<HenyeyGreensteinCase> cases;
    const glm::vec3 wo(0, 0.6f, 0.8f);
    for (int i = 0; i < 200; ++i) { // stratified: 200 cosines by 200 azimuths
      for (int j = 0; j < 200; ++j) {
        const double z = -1 + (i + 0.5) / 100, r = std::sqrt(1 - z * z), phi = (j + 0.5) * std::numbers::pi / 100;
        cases.push_back({wo, g, glm::vec3(glm::dvec3(r * std::cos(phi), r * std::sin(phi), z)), {0, 0}});
      }
    }
    double mass = 0;
    for (const auto& result : run(cases))
      mass += result.value * 4 * std::numbers::pi / static_cast<double>(cases.size());
    EXPECT_NEAR(mass, 1, 1e-3) << g;
  }
}

TEST(HenyeyGreenstein, ExtremeNumbersGiveUnitVectorsOfPositiveDensity) {
  std::vector<HenyeyGreensteinCase> cases;
  const float last = 1 - std::ldexp(1.0f, -24);
  for (const float g : kAnisotropies) {
    for (const float x : {0.0f, std::ldexp(1.0f, -24), 0.5f, last - std::ldexp(1.0f, -24), last}) {
      for (const float y : {0.0f, 0.25f, last}) cases.push_back({{0, 0, 1}, g, {0, 0, 1}, {x, y}});
    }
  }
  for (const auto& result : run(cases)) {
    ASSERT_NEAR(glm::length(glm::dvec3(result.sampled)), 1, 1e-6);
    ASSERT_TRUE(std::isfinite(result.sampledValue) && result.sampledValue > 0);
  }
}

} // namespace
} // namespace isophote
