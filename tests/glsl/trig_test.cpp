#include "glsl/trig_case.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "isophote/settings.hpp"
#include "render/setting_ids.hpp"
#include "support/probe.hpp"
#include "test_glsl_kernels.hpp"

namespace isophote {
namespace {

using gpu::TrigCase;
using gpu::TrigResult;

std::vector<TrigResult> run(const std::vector<TrigCase>& cases, std::span<const gpu::SpecConstant> settings = {}) {
  return test::runProbe<TrigCase, TrigResult>(test_glsl_kernels::kernelSource("trig_probe"), cases, 0, settings);
}

double ulp(double value) {
  const float magnitude = std::max(std::abs(static_cast<float>(value)), 1.17549435e-38f);
  return static_cast<double>(std::nextafter(magnitude, 3e38f)) - magnitude;
}

/// Ulps where those are what counts, else 0 for an absolute error up to 1e-7.
double sinCosError(double value, double expected) {
  const double error = std::abs(value - expected);
  return error <= 1e-7 ? 0 : error / ulp(expected);
}

TEST(Trigonometry, SinCosPiStaysWithinFourUlpOver1e6Arguments) {
  std::mt19937 generator(58);
  std::uniform_real_distribution<float> whole(-2, 2);
  std::uniform_real_distribution<float> exponent(-40, 0);
  std::vector<TrigCase> cases;
  for (int i = 0; i < 900'000; ++i) cases.push_back({0, whole(generator)});
  for (int i = 0; i < 100'000; ++i) cases.push_back({0, std::exp2(exponent(generator)) * (i % 2 == 0 ? 1.0f : -1.0f)});
  for (int i = -16; i <= 16; ++i) { // where the quadrant changes
    const float x = static_cast<float>(i) / 8;
    for (const float near : {std::nextafter(x, -3.0f), x, std::nextafter(x, 3.0f)}) cases.push_back({0, near});
  }
  const auto results = run(cases);
  double worst = 0;
  double worstAbsolute = 0;
  double worstBuiltIn = 0;
  for (size_t i = 0; i < cases.size(); ++i) {
    const double angle = std::numbers::pi * static_cast<double>(cases[i].x);
    const double s = std::sin(angle);
    const double c = std::cos(angle);
    worst = std::max({worst, sinCosError(results[i].sinCosPi.x, s), sinCosError(results[i].sinCosPi.y, c)});
    worstAbsolute = std::max({worstAbsolute, std::abs(results[i].sinCosPi.x - s), std::abs(results[i].sinCosPi.y - c)});
    if (std::abs(cases[i].x) > 1) continue; // Vulkan promises nothing there
    worstBuiltIn =
        std::max({worstBuiltIn, std::abs(results[i].builtInSinCos.x - s), std::abs(results[i].builtInSinCos.y - c)});
  }
  RecordProperty("worstUlp", std::to_string(worst));
  RecordProperty("worstAbsolute", std::to_string(worstAbsolute * 1e9) + "e-9");
  RecordProperty("builtInWorstAbsolute", std::to_string(worstBuiltIn * 1e9) + "e-9");
  EXPECT_LE(worst, 4);
  EXPECT_LE(worstAbsolute, 2e-7);
}

TEST(Trigonometry, SinCosPiIsExactAtHalves) {
  std::vector<TrigCase> cases;
  for (int i = -4; i <= 4; ++i) cases.push_back({0, static_cast<float>(i) / 2});
  const auto results = run(cases);
  const float sine[] = {0, 1, 0, -1, 0, 1, 0, -1, 0};
  const float cosine[] = {1, 0, -1, 0, 1, 0, -1, 0, 1};
  for (size_t i = 0; i < cases.size(); ++i) {
    EXPECT_EQ(results[i].sinCosPi.x, sine[i]) << cases[i].x;
    EXPECT_EQ(results[i].sinCosPi.y, cosine[i]) << cases[i].x;
  }
}

TEST(Trigonometry, SmallSinesKeepTheirRelativePrecision) {
  std::vector<TrigCase> cases;
  for (int e = -100; e <= -8; ++e) cases.push_back({0, std::ldexp(1.3f, e)});
  const auto results = run(cases);
  for (size_t i = 0; i < cases.size(); ++i) {
    const double expected = std::sin(std::numbers::pi * static_cast<double>(cases[i].x));
    EXPECT_NEAR(results[i].sinCosPi.x / expected, 1, 3e-7) << cases[i].x;
  }
}

TEST(Trigonometry, Atan2PiStaysWithin1e6OfDoubleAtEveryScale) {
  std::mt19937 generator(35);
  std::normal_distribution<float> normal;
  std::uniform_real_distribution<float> exponent(-80, 80); // quotients and coordinates stay normal numbers
  std::vector<TrigCase> cases;
  for (int i = 0; i < 300'000; ++i) {
    const float scale = std::exp2(exponent(generator));
    const float squeeze = i % 3 == 0 ? std::exp2(-std::abs(exponent(generator)) / 3) : 1.0f;
    cases.push_back({normal(generator) * scale * squeeze, normal(generator) * scale});
    if (i % 5 == 0) std::swap(cases.back().x, cases.back().y);
  }
  const auto results = run(cases);
  double worst = 0;
  double worstBuiltIn = 0;
  for (size_t i = 0; i < cases.size(); ++i) {
    const double expected =
        std::atan2(static_cast<double>(cases[i].y), static_cast<double>(cases[i].x)) / std::numbers::pi;
    worst = std::max(worst, std::abs(results[i].atan2Pi / expected - 1));
    worstBuiltIn = std::max(worstBuiltIn, std::abs(results[i].builtInAtan2 / expected - 1));
  }
  RecordProperty("worstRelative", std::to_string(worst * 1e9) + "e-9");
  RecordProperty("builtInWorstRelative", std::to_string(worstBuiltIn * 1e9) + "e-9");
  EXPECT_LE(worst, 1e-6);
}

// The bounds are Vulkan's: 2^-11 absolute for sine and cosine, 4096 ulp for the angle.
TEST(Trigonometry, TheDevicesOwnIsTakenWhereAskedFor) {
  const gpu::SpecConstant device[] = {{setting_id::kTrigonometry, static_cast<uint32_t>(Trigonometry::Device)}};
  std::mt19937 generator(59);
  std::uniform_real_distribution<float> whole(-2, 2);
  std::vector<TrigCase> cases = {{0, 0}};
  for (int i = 0; i < 10'000; ++i) cases.push_back({whole(generator), whole(generator)});
  const auto results = run(cases, device);
  const auto own = run(cases);
  size_t different = 0;
  for (size_t i = 0; i < cases.size(); ++i) {
    const double x = cases[i].x, y = cases[i].y;
    ASSERT_NEAR(results[i].sinCosPi.x, std::sin(std::numbers::pi * x), 0x1p-11) << x;
    ASSERT_NEAR(results[i].sinCosPi.y, std::cos(std::numbers::pi * x), 0x1p-11) << x;
    ASSERT_NEAR(results[i].atan2Pi, std::atan2(y, x) / std::numbers::pi, 4096 * 0x1p-23) << y << " " << x;
    different += results[i].sinCosPi != own[i].sinCosPi || results[i].atan2Pi != own[i].atan2Pi;
  }
  EXPECT_GT(different, 0u);
}

TEST(Trigonometry, Atan2PiIsExactOnTheAxes) {
  const auto results = run({{0, 1}, {1, 0}, {-1, 0}, {0, 0}, {0, -1}});
  EXPECT_EQ(results[0].atan2Pi, 0.0f);
  EXPECT_EQ(results[1].atan2Pi, 0.5f);
  EXPECT_EQ(results[2].atan2Pi, -0.5f);
  EXPECT_EQ(results[3].atan2Pi, 0.0f);
  EXPECT_EQ(results[4].atan2Pi, 1.0f);
}

} // namespace
} // namespace isophote
