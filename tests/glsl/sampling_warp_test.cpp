#include "glsl/sampling_warp_case.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "support/probe.hpp"
#include "support/statistics.hpp"
#include "test_glsl_kernels.hpp"

namespace isophote {
namespace {

using gpu::SamplingWarpCase;
using gpu::SamplingWarpResult;

constexpr uint32_t kSamples = 1'000'000;
constexpr double kPi = std::numbers::pi;

std::vector<SamplingWarpResult> run(const std::vector<SamplingWarpCase>& cases) {
  return test::runProbe<SamplingWarpCase, SamplingWarpResult>(test_glsl_kernels::kernelSource("sampling_warp_probe"),
                                                              cases);
}

float lattice(uint32_t k) { return std::ldexp(static_cast<float>(k), -24); }

std::vector<SamplingWarpResult> randomSamples(uint32_t warp, float oneMinusCosMax) {
  std::mt19937 generator(1);
  std::vector<SamplingWarpCase> cases(kSamples);
  for (auto& c : cases) {
    c = {{lattice(static_cast<uint32_t>(generator()) >> 8), lattice(static_cast<uint32_t>(generator()) >> 8)},
         warp,
         oneMinusCosMax};
  }
  return run(cases);
}

double turn(double y, double x) {
  const double turns = std::atan2(y, x) / (2 * kPi) + 0.5;
  return std::min(turns, 1 - 1e-12);
}

double oneMinusCos(const glm::dvec3& v) {
  const double squared = v.x * v.x + v.y * v.y;
  return v.z < 0 ? 1 - v.z : squared / (1 + std::sqrt(std::max(1 - squared, 0.0)));
}

/// Coordinates in [0, 1]^2 in which the density is constant, and the density, both from the definition of the warp.
struct Definition {
  uint32_t warp;
  float oneMinusCosMax;
  std::function<glm::dvec2(const glm::dvec3&)> coordinates;
  std::function<double(const glm::dvec3&)> pdf;
};

std::vector<Definition> definitions() {
  const auto cone = [](double limit) {
    return Definition{gpu::kWarpCone, static_cast<float>(limit),
                      [limit](const glm::dvec3& p) { return glm::dvec2(turn(p.y, p.x), oneMinusCos(p) / limit); },
                      [limit](const glm::dvec3&) { return 1 / (2 * kPi * limit); }};
  };
  return {
      {gpu::kWarpDisk, 0, [](const glm::dvec3& p) { return glm::dvec2(turn(p.y, p.x), p.x * p.x + p.y * p.y); },
       [](const glm::dvec3&) { return 1 / kPi; }},
      {gpu::kWarpCosineHemisphere, 0, [](const glm::dvec3& p) { return glm::dvec2(turn(p.y, p.x), p.z * p.z); },
       [](const glm::dvec3& p) { return p.z / kPi; }},
      {gpu::kWarpSphere, 0, [](const glm::dvec3& p) { return glm::dvec2(turn(p.y, p.x), 0.5 + 0.5 * p.z); },
       [](const glm::dvec3&) { return 1 / (4 * kPi); }},
      cone(static_cast<double>(0.3f)),
      cone(static_cast<double>(1.7f)),
      cone(static_cast<double>(5e-9f)), // half angle 1e-4: the sun of test 25
      {gpu::kWarpTriangle, 0,
       [](const glm::dvec3& b) { // Turk's square root map backwards
         const double s = b.x + b.y;
         return glm::dvec2(b.x / s, s * s);
       },
       [](const glm::dvec3&) { return 2.0; }},
  };
}

// 32 x 32 bins of 977 expected counts: a bias of 1% over half the domain shows at p < 1e-9, a single bin 20% off too.
TEST(Warp, SamplesFollowTheirDensityByChiSquare) {
  const auto all = definitions();
  const std::vector<double> expected(32 * 32, kSamples / 1024.0);
  for (const Definition& definition : all) {
    std::vector<uint64_t> counts(expected.size());
    for (const auto& result : randomSamples(definition.warp, definition.oneMinusCosMax)) {
      const glm::dvec2 c = definition.coordinates(glm::dvec3(result.point));
      ASSERT_TRUE(c.x >= 0 && c.y >= 0 && c.x <= 1 && c.y <= 1 + 1e-5) << definition.warp;
      ++counts[std::min<size_t>(static_cast<size_t>(c.y * 32), 31) * 32 +
               std::min<size_t>(static_cast<size_t>(c.x * 32), 31)];
    }
    const double p = test::chiSquareTest(counts, expected).p;
    EXPECT_GT(p, test::sidak(0.001, all.size())) << definition.warp << " " << definition.oneMinusCosMax;
  }
}

TEST(Warp, DensityMatchesItsDefinition) {
  for (const Definition& definition : definitions()) {
    for (const auto& result : randomSamples(definition.warp, definition.oneMinusCosMax)) {
      ASSERT_NEAR(result.pdf / definition.pdf(glm::dvec3(result.point)), 1, 1e-6) << definition.warp;
    }
  }
}

TEST(Warp, ExtremeNumbersGiveFinitePointsInsideTheDomainWithPositiveDensity) {
  const uint32_t last = (1u << 24) - 1;
  const uint32_t values[] = {0, 1, 2, last / 4, last / 2, last / 2 + 1, last / 2 + 2, last - 1, last};
  std::vector<SamplingWarpCase> cases;
  for (uint32_t warp = 0; warp < gpu::kWarpCount; ++warp) {
    for (const float limit : {1e-30f, 5e-9f, 0.5f, 2.0f}) {
      for (const uint32_t x : values) {
        for (const uint32_t y : values) cases.push_back({{lattice(x), lattice(y)}, warp, limit});
      }
    }
  }
  const auto results = run(cases);
  for (size_t i = 0; i < cases.size(); ++i) {
    const glm::dvec3 p(results[i].point);
    const auto& c = cases[i];
    SCOPED_TRACE(testing::Message() << "warp " << c.warp << " u " << c.u.x << " " << c.u.y);
    ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
    ASSERT_TRUE(std::isfinite(results[i].pdf) && results[i].pdf > 0);
    if (c.warp == gpu::kWarpDisk) {
      ASSERT_LT(p.x * p.x + p.y * p.y, 1 + 2e-7);
    } else if (c.warp == gpu::kWarpTriangle) {
      ASSERT_TRUE(p.x >= 0 && p.y >= 0 && p.z >= 0);
      ASSERT_NEAR(p.x + p.y + p.z, 1, 1.2e-7);
    } else {
      ASSERT_NEAR(glm::length(p), 1, 3e-7);
    }
    if (c.warp == gpu::kWarpCosineHemisphere) {
      ASSERT_GT(p.z, 0);
    } else if (c.warp == gpu::kWarpCone) {
      ASSERT_LE(oneMinusCos(p), c.oneMinusCosMax * (1 + 1e-6));
    }
  }
}

} // namespace
} // namespace isophote
