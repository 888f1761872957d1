#include "glsl/light_punctual_case.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "isophote/scene.hpp"
#include "support/probe.hpp"
#include "test_glsl_kernels.hpp"

namespace isophote {
namespace {

using gpu::LightPunctualCase;
using gpu::LightPunctualResult;

std::vector<LightPunctualResult> run(const std::vector<LightPunctualCase>& cases) {
  return test::runProbe<LightPunctualCase, LightPunctualResult>(test_glsl_kernels::kernelSource("light_punctual_probe"),
                                                                cases);
}

gpu::PunctualLightRecord point(glm::vec3 position, float intensity) {
  gpu::PunctualLightRecord light{};
  light.position = position;
  light.kind = gpu::kLightPoint;
  light.intensity = glm::vec3(intensity);
  return light;
}

TEST(PunctualLight, PointLightFollowsTheInverseSquareAtEveryScale) {
  std::mt19937 generator(26);
  std::normal_distribution<float> normal;
  std::uniform_real_distribution<float> exponent(-30, 30);
  std::vector<LightPunctualCase> cases;
  for (int i = 0; i < 20'000; ++i) {
    const float scale = std::exp2(exponent(generator));
    auto light = point(scale * glm::vec3(normal(generator), normal(generator), normal(generator)), scale);
    light.intensity = glm::vec3(1, 2, 3) * scale;
    cases.push_back({light, scale * glm::vec3(normal(generator), normal(generator), normal(generator))});
  }
  const auto results = run(cases);
  for (size_t i = 0; i < cases.size(); ++i) {
    // The light's position is given exactly, so is the difference but for one rounding of each coordinate.
    const glm::dvec3 toLight = glm::dvec3(cases[i].light.position) - glm::dvec3(cases[i].p);
    const double d2 = glm::dot(toLight, toLight);
    ASSERT_NEAR(results[i].distance / std::sqrt(d2), 1, 1e-6) << i;
    ASSERT_LT(glm::length(glm::dvec3(results[i].wi) - toLight / std::sqrt(d2)), 1e-6) << i;
    for (int c = 0; c < 3; ++c) {
      ASSERT_NEAR(results[i].irradiance[c] * d2 / cases[i].light.intensity[c], 1, 1e-5) << i;
    }
  }
}

TEST(PunctualLight, DirectionalLightIsTheSameEverywhere) {
  gpu::PunctualLightRecord light{};
  light.kind = gpu::kLightDirectional;
  light.direction = glm::normalize(glm::vec3(1, -2, 0.5f));
  light.intensity = {3, 2, 1};
  light.position = {9, 9, 9};
  light.range = 0.1f; // has no meaning for it
  for (const auto& result : run({{light, {0, 0, 0}}, {light, {1e10f, 5, -3}}})) {
    EXPECT_EQ(result.irradiance, light.intensity);
    EXPECT_EQ(result.wi, -light.direction);
    EXPECT_EQ(result.distance, 3.402823466e38f);
  }
}

TEST(PunctualLight, RangeEndsTheLightByTheRecommendedWindow) {
  auto light = point({0, 0, 0}, 7);
  light.range = 4;
  std::vector<LightPunctualCase> cases;
  for (int i = 1; i <= 60; ++i) cases.push_back({light, {0, 0.1f * static_cast<float>(i), 0}});
  const auto results = run(cases);
  for (size_t i = 0; i < cases.size(); ++i) {
    const double d = cases[i].p.y;
    const double window = std::max(std::min(1 - std::pow(d / 4, 4), 1.0), 0.0);
    EXPECT_NEAR(results[i].irradiance.x, 7 * window / (d * d), 1e-6 * 7 / (d * d)) << d;
    if (d >= 4) {
      EXPECT_EQ(results[i].irradiance.x, 0) << d;
    }
  }
}

TEST(PunctualLight, SpotFallsOffBetweenItsCones) {
  auto light = point({1, 2, 3}, 5);
  light.kind = gpu::kLightSpot;
  light.direction = glm::vec3(0, 0, -1);
  const std::pair<double, double> cones[] = {{0.3, 0.8}, {0, 0.7853981634}, {0.5, 0.5000001}, {1.0, 1.57}};
  for (const auto& [inner, outer] : cones) {
    light.cosInner = static_cast<float>(std::cos(inner));
    light.cosOuter = static_cast<float>(std::cos(outer));
    std::vector<LightPunctualCase> cases;
    for (int i = 0; i <= 300; ++i) {
      const double angle = 0.01 * i;
      cases.push_back({light, light.position + glm::vec3(2 * std::sin(angle), 0, -2 * std::cos(angle))});
    }
    const auto results = run(cases);
    for (size_t i = 0; i < cases.size(); ++i) {
      const glm::dvec3 away = glm::dvec3(cases[i].p) - glm::dvec3(light.position);
      // KHR_lights_punctual, "Inner and Outer Cone Angles"
      const double scale =
          1 / std::max(0.001, static_cast<double>(light.cosInner) - static_cast<double>(light.cosOuter));
      const double offset = -static_cast<double>(light.cosOuter) * scale;
      const double cosine = -away.z / glm::length(away);
      const double falloff = std::clamp(cosine * scale + offset, 0.0, 1.0);
      const double full = 5 / glm::dot(away, away);
      // A cosine is good to 2e-7; the slope of the falloff is 2 scale.
      EXPECT_NEAR(results[i].irradiance.y, full * falloff * falloff, full * (1e-6 + 4e-7 * scale)) << inner << " " << i;
    }
  }
}

TEST(PunctualLight, LightAtThePointItselfGivesNothingButNoInfinity) {
  for (const auto& result : run({{point({1, 1, 1}, 3), {1, 1, 1}}, {point({1e-16f, 0, 0}, 3), {0, 0, 0}}})) {
    EXPECT_EQ(result.irradiance, glm::vec3(0));
  }
  const auto near = run({{point({1e-14f, 0, 0}, 3), {0, 0, 0}}})[0];
  EXPECT_NEAR(near.irradiance.x / 3e28, 1, 1e-5);
}

} // namespace
} // namespace isophote
