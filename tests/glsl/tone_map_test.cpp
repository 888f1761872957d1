// The device's tone mapping against isophote::toneMap, which tests/unit/io_tone_map_test.cpp holds to the published
// formulas.
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "glsl/tone_map_case.h"
#include "isophote/image.hpp"
#include "support/probe.hpp"
#include "test_glsl_kernels.hpp"

namespace isophote {
namespace {

using gpu::ToneMapCase;
using gpu::ToneMapResult;

std::vector<ToneMapResult> onDevice(const std::vector<ToneMapCase>& cases) {
  return test::runProbe<ToneMapCase, ToneMapResult>(test_glsl_kernels::kernelSource("tone_map_probe"), cases);
}

// A hundredth of an 8-bit step. Vulkan's log2 may be off by 3 ulp (2^-21 near 1) and exp2 by 3 + 2 |x| ulp; the AgX
// polynomial multiplies that by up to 30.
constexpr float kTolerance = 4e-5f;

TEST(ToneMapGlsl, EqualsTheHostForAllOperators) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> stops(-14, 12);
  std::vector<ToneMapCase> cases;
  for (uint32_t operation = 0; operation < 5; ++operation) {
    for (int i = 0; i < 4000; ++i) {
      cases.push_back({{std::exp2(stops(random)), std::exp2(stops(random)), std::exp2(stops(random))}, operation});
    }
    cases.push_back({{0, 0, 0}, operation});
    cases.push_back({{1e15f, 1e15f, 1e15f}, operation});
  }
  const auto results = onDevice(cases);
  for (size_t i = 0; i < cases.size(); ++i) {
    const glm::vec3 expected = toneMap(cases[i].color, static_cast<ToneMap>(cases[i].operation));
    for (int c = 0; c < 3; ++c) {
      ASSERT_NEAR(results[i].display[c], expected[c], kTolerance)
          << "operator " << cases[i].operation << " of " << cases[i].color.r << ", " << cases[i].color.g << ", "
          << cases[i].color.b;
    }
  }
}

TEST(ToneMapGlsl, StaysInRangeForEveryInput) {
  const float infinity = std::numeric_limits<float>::infinity();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float values[] = {0, -0.0f, 1e-45f, 1e-10f, 0.18f, 1, 1e15f, 3.4e38f, infinity, -infinity, -1, nan, -nan};
  std::vector<ToneMapCase> cases;
  for (uint32_t operation = 0; operation < 5; ++operation) {
    for (const float r : values) {
      for (const float g : values) {
        for (const float b : values) cases.push_back({{r, g, b}, operation});
      }
    }
  }
  for (const ToneMapResult& result : onDevice(cases)) {
    for (int c = 0; c < 3; ++c) ASSERT_TRUE(result.display[c] >= 0 && result.display[c] <= 1) << result.display[c];
  }
}

} // namespace
} // namespace isophote
