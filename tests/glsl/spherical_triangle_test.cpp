#include "glsl/spherical_triangle_case.h"

#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "oracle/spherical_triangle.hpp"
#include "support/probe.hpp"
#include "support/statistics.hpp"
#include "test_glsl_kernels.hpp"

namespace isophote {
namespace {

using gpu::SphericalTriangleCase;
using gpu::SphericalTriangleResult;

std::vector<SphericalTriangleResult> run(const std::vector<SphericalTriangleCase>& cases) {
  return test::runProbe<SphericalTriangleCase, SphericalTriangleResult>(
      test_glsl_kernels::kernelSource("spherical_triangle_probe"), cases);
}

using Corners = std::array<glm::dvec3, 3>;

Corners cornersOf(const SphericalTriangleCase& c) { return {glm::dvec3(c.v0), glm::dvec3(c.v1), glm::dvec3(c.v2)}; }

glm::vec3 randomVector(std::mt19937& generator) {
  std::normal_distribution<float> normal;
  return {normal(generator), normal(generator), normal(generator)};
}

// The determinant cancels as the receiver nears the triangle's plane and as the triangle gets thin: the error is
// relative to the sines of both angles.
TEST(SphericalTriangle, SolidAngleMatchesGirardsTheorem) {
  std::mt19937 generator(22);
  std::vector<SphericalTriangleCase> cases;
  for (int i = 0; i < 20'000; ++i) {
    SphericalTriangleCase c{};
    const float size = std::pow(10.0f, -static_cast<float>(i % 3));
    const glm::vec3 center = randomVector(generator);
    c.p = 0.3f * randomVector(generator);
    c.v0 = center + size * randomVector(generator);
    c.v1 = center + size * randomVector(generator);
    c.v2 = center + size * randomVector(generator);
    cases.push_back(c);
  }
  const auto results = run(cases);
  int stable = 0;
  for (size_t i = 0; i < cases.size(); ++i) {
    const Corners v = cornersOf(cases[i]);
    const glm::dvec3 p(cases[i].p);
    const double expected = oracle::solidAngle(v, p);
    const glm::dvec3 corner = glm::cross(glm::normalize(v[1] - v[0]), glm::normalize(v[2] - v[0]));
    const double sine = std::abs(glm::dot(corner, glm::normalize(v[0] - p)));
    ASSERT_NEAR(results[i].solidAngle / expected, 1, 4e-6 + 1e-6 / sine) << i << " " << expected;
    ASSERT_EQ(results[i].stable != 0, results[i].solidAngle >= 3e-4f && results[i].solidAngle <= 6.22f) << i;
    stable += results[i].stable != 0;
  }
  EXPECT_GT(stable, 12'000);
}

TEST(SphericalTriangle, EdgeOnAndTouchingTrianglesAreNotSampledBySolidAngle) {
  const glm::vec3 v0(0, 0, 0), v1(1, 0, 0), v2(0, 1, 0);
  const std::vector<SphericalTriangleCase> cases = {{{3, 4, 0}, v0, v1, v2, {0.5f, 0.5f}},
                                                    {{0, 0, 0}, v0, v1, v2, {0.5f, 0.5f}},
                                                    {{0.2f, 0.2f, 0}, v0, v1, v2, {0.5f, 0.5f}},
                                                    {{0.2f, 0.2f, 1e-4f}, v0, v1, v2, {0.5f, 0.5f}},
                                                    {{0, 0, 1}, v0, v0, v2, {0.5f, 0.5f}}};
  for (const auto& result : run(cases)) EXPECT_EQ(result.stable, 0u) << result.solidAngle;
}

// Each triangle is cut into 100 congruent parts. 1e6 samples: the largest parts 2% off, or many of them 0.5% off.
TEST(SphericalTriangle, DirectionsAreUniformByChiSquare) {
  constexpr uint32_t kRows = 10;
  struct Shape {
    const char* name;
    Corners corners;
  };
  // The receiver is the origin: an ordinary one, one that nearly surrounds it, a sliver, a small one, a grazing one.
  const Shape shapes[] = {{"ordinary", {glm::dvec3(1, 0.2, 0.5), {-0.3, 1, 0.7}, {-0.5, -0.4, 1.2}}},
                          {"surrounding", {glm::dvec3(10, 0, 0.2), {-5, 8.7, 0.2}, {-5, -8.7, 0.2}}},
                          {"sliver", {glm::dvec3(-3, 0, 1), {3, 0, 1}, {3, 0.02, 1}}},
                          {"small", {glm::dvec3(0, 0, 1), {0.03, 0, 1.01}, {0, 0.03, 0.98}}},
                          {"grazing", {glm::dvec3(0.1, -1, 0.02), {0.1, 1, 0.02}, {9, 0, 0.05}}}};
  std::mt19937 generator(7);
  for (const Shape& shape : shapes) {
    SCOPED_TRACE(shape.name);
    std::vector<SphericalTriangleCase> cases(1'000'000);
    for (auto& c : cases) {
      c = {glm::vec3(0),
           glm::vec3(shape.corners[0]),
           glm::vec3(shape.corners[1]),
           glm::vec3(shape.corners[2]),
           {std::ldexp(static_cast<float>(generator() >> 8), -24),
            std::ldexp(static_cast<float>(generator() >> 8), -24)}};
    }
    const Corners v = cornersOf(cases[0]);
    const auto part = [&](double b1, double b2) { return v[0] + b1 * (v[1] - v[0]) + b2 * (v[2] - v[0]); };
    // Bin of barycentrics (b1, b2): row, column, and which of the cell's two triangles.
    std::vector<uint64_t> counts(2 * kRows * kRows);
    for (const auto& result : run(cases)) {
      ASSERT_EQ(result.stable, 1u);
      for (int k = 0; k < 3; ++k) ASSERT_TRUE(result.barycentrics[k] >= 0 && result.barycentrics[k] <= 1.000001f);
      ASSERT_NEAR(result.barycentrics.x + result.barycentrics.y + result.barycentrics.z, 1, 1e-6);
      const double x = static_cast<double>(result.barycentrics.y) * kRows;
      const double y = static_cast<double>(result.barycentrics.z) * kRows;
      const auto i = std::min(static_cast<uint32_t>(x), kRows - 1), j = std::min(static_cast<uint32_t>(y), kRows - 1);
      const bool upper = (x - i) + (y - j) > 1 && i + j + 1 < kRows;
      ++counts[2 * (i * kRows + j) + upper];
    }
    const double total = oracle::solidAngle(v, glm::dvec3(0));
    std::vector<double> expected(counts.size());
    double sum = 0;
    for (uint32_t i = 0; i < kRows; ++i) {
      for (uint32_t j = 0; i + j < kRows; ++j) {
        const double h = 1.0 / kRows;
        const auto share = [&](Corners corners) { return oracle::solidAngle(corners, glm::dvec3(0)) / total * 1e6; };
        sum += expected[2 * (i * kRows + j)] =
            share({part(i * h, j * h), part(i * h + h, j * h), part(i * h, j * h + h)});
        if (i + j + 1 < kRows) {
          sum += expected[2 * (i * kRows + j) + 1] =
              share({part(i * h + h, j * h), part(i * h + h, j * h + h), part(i * h, j * h + h)});
        }
      }
    }
    ASSERT_NEAR(sum, 1e6, 1e-3);
    const auto chi = test::chiSquareTest(counts, expected);
    EXPECT_GT(chi.p, test::sidak(0.001, std::size(shapes)));
  }
}

} // namespace
} // namespace isophote
