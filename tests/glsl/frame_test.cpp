#include "glsl/frame_case.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "support/probe.hpp"
#include "test_glsl_kernels.hpp"

namespace isophote {
namespace {

using gpu::FrameCase;
using gpu::FrameResult;

std::vector<FrameResult> run(const std::vector<FrameCase>& cases) {
  return test::runProbe<FrameCase, FrameResult>(test_glsl_kernels::kernelSource("frame_probe"), cases);
}

glm::vec3 randomUnit(std::mt19937& generator) {
  std::normal_distribution<double> normal;
  return glm::vec3(glm::normalize(glm::dvec3(normal(generator), normal(generator), normal(generator))));
}

/// Sum of squares of what separates (t, b, n) from an orthonormal triple.
double nonOrthogonality(const glm::dvec3& t, const glm::dvec3& b, const glm::dvec3& n) {
  const double terms[] = {glm::dot(t, t) - 1, glm::dot(b, b) - 1, glm::dot(t, b), glm::dot(t, n), glm::dot(b, n)};
  double sum = 0;
  for (const double term : terms) sum += term * term;
  return sum;
}

// The vectors on which Frisvad's basis fails (Duff et al. 2017, section 2), the axes, and 1e6 random normals.
TEST(Frame, IsOrthonormalAndRightHandedForEveryNormal) {
  std::mt19937 generator(14);
  std::vector<FrameCase> cases;
  const auto add = [&](const glm::vec3& n) { cases.push_back({n, {1, 0, 0}, 1}); };
  add({0.00038527316f, 0.00038460016f, -0.99999988079f});
  add({-0.00019813581f, -0.00008946839f, -0.99999988079f});
  for (int axis = 0; axis < 3; ++axis) {
    for (const float sign : {1.0f, -1.0f}) {
      glm::vec3 n(0);
      n[axis] = sign;
      add(n);
    }
  }
  add({1, 0, -0.0f});
  for (int i = 0; i < 1'000'000; ++i) add(randomUnit(generator));
  const auto results = run(cases);
  double worst = 0;
  double sum = 0;
  for (size_t i = 0; i < cases.size(); ++i) {
    const glm::dvec3 t(results[i].tangent);
    const glm::dvec3 b(results[i].bitangent);
    const glm::dvec3 n(cases[i].normal);
    const double error = nonOrthogonality(t, b, n);
    worst = std::max(worst, error);
    sum += error;
    ASSERT_GT(glm::dot(glm::cross(t, b), n), 0.999) << i;
  }
  EXPECT_LT(sum / static_cast<double>(cases.size()), 1e-13); // mean square: 3e-7 RMS
  EXPECT_LT(worst, 1e-12);
}

TEST(Frame, LocalAndBackIsTheIdentity) {
  std::mt19937 generator(15);
  std::vector<FrameCase> cases;
  for (int i = 0; i < 10'000; ++i) cases.push_back({randomUnit(generator), randomUnit(generator), 1});
  const auto results = run(cases);
  for (size_t i = 0; i < cases.size(); ++i) {
    ASSERT_LT(glm::length(glm::dvec3(results[i].roundTrip) - glm::dvec3(cases[i].tangent)), 1e-6) << i;
  }
}

TEST(Frame, GivenTangentKeepsItsSideAndHandedness) {
  std::mt19937 generator(16);
  std::vector<FrameCase> cases;
  for (int i = 0; i < 10'000; ++i) {
    cases.push_back({randomUnit(generator), randomUnit(generator) * 3.0f, i % 2 == 0 ? 1.0f : -1.0f});
  }
  const auto results = run(cases);
  for (size_t i = 0; i < cases.size(); ++i) {
    const glm::dvec3 n(cases[i].normal);
    const glm::dvec3 given(cases[i].tangent);
    const glm::dvec3 t(results[i].tangentGiven);
    const glm::dvec3 b(results[i].bitangentGiven);
    const glm::dvec3 expected = given - glm::dot(n, given) * n;
    // Rounding of the projection is amplified by how close the tangent is to the normal.
    const double tolerance = 1e-6 * glm::length(given) / glm::length(expected);
    ASSERT_LT(glm::length(t - glm::normalize(expected)), tolerance) << i;
    ASSERT_LT(std::sqrt(nonOrthogonality(t, b, n)), 2 * tolerance + 1e-6) << i;
    ASSERT_GT(cases[i].handedness * glm::dot(glm::cross(n, t), b), 0.999) << i;
  }
}

TEST(Frame, TangentAlongTheNormalOrZeroFallsBackToACompleteFrame) {
  const glm::vec3 n = glm::normalize(glm::vec3(1, 2, 3));
  for (const FrameResult& result : run({{n, n, 1}, {n, -5.0f * n, -1}, {n, glm::vec3(0), 1}})) {
    EXPECT_LT(nonOrthogonality(glm::dvec3(result.tangentGiven), glm::dvec3(result.bitangentGiven), glm::dvec3(n)),
              1e-10);
  }
}

TEST(Frame, SafeNormalizeWorksFrom1e36BelowTo1e37) {
  std::mt19937 generator(17);
  std::vector<FrameCase> cases;
  for (int e = -35; e <= 37; ++e) {
    for (int k = 0; k < 20; ++k)
      cases.push_back({{0, 1, 0}, randomUnit(generator) * std::pow(10.0f, static_cast<float>(e)), 1});
  }
  const auto results = run(cases);
  for (size_t i = 0; i < cases.size(); ++i) {
    const glm::dvec3 expected = glm::normalize(glm::dvec3(cases[i].tangent));
    ASSERT_LT(glm::length(glm::dvec3(results[i].normalized) - expected), 5e-7) << i;
  }
  EXPECT_EQ(run({{{0, 1, 0}, {0, 0, 0}, 1}})[0].normalized, glm::vec3(0, 1, 0));
}

} // namespace
} // namespace isophote
