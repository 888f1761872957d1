#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "glsl/offset_case.h"
#include "glsl/traversal_scene.hpp"
#include "isophote/settings.hpp"
#include "render/setting_ids.hpp"
#include "support/probe.hpp"
#include "test_glsl_kernels.hpp"

using namespace isophote;
using gpu::LeaveCase;
using gpu::LeaveResult;
using gpu::OffsetCase;
using gpu::OffsetResult;

namespace {

// offsetRayOrigin from its description (pbrt 4ed, 6.8.6), rounded step by step; the compiler keeps the order of float
// operations and does not contract them (tests are built for baseline x86-64, which has no fma).
glm::vec3 referenceOrigin(const OffsetCase& c) {
  const float d = (std::abs(c.ng.x) * c.pError.x + std::abs(c.ng.y) * c.pError.y) + std::abs(c.ng.z) * c.pError.z;
  const double side = double(c.w.x) * c.ng.x + double(c.w.y) * c.ng.y + double(c.w.z) * c.ng.z;
  glm::vec3 origin;
  for (int axis = 0; axis < 3; ++axis) {
    const float offset = (side < 0 ? -d : d) * c.ng[axis];
    origin[axis] = c.p[axis] + offset;
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    if (offset > 0) origin[axis] = std::nextafter(origin[axis], kInfinity);
    if (offset < 0) origin[axis] = std::nextafter(origin[axis], -kInfinity);
  }
  return origin;
}

bool sameBits(glm::vec3 a, glm::vec3 b) {
  for (int axis = 0; axis < 3; ++axis) {
    if (std::bit_cast<uint32_t>(a[axis]) != std::bit_cast<uint32_t>(b[axis])) return false;
  }
  return true;
}

void setRows(const glm::dmat4& map, gpu::vec4 (&rows)[3]) {
  for (int row = 0; row < 3; ++row) rows[row] = glm::vec4(map[0][row], map[1][row], map[2][row], map[3][row]);
}

struct Leaves {
  std::vector<LeaveCase> cases;
  std::vector<glm::dmat4> placements;
};

// Triangles with coordinates of size 10^U(-8, 8), numbers 41 of the reliability list; each left by rays that rise at
// least 1e-3 over its plane: a rounded direction may dip below it at less than about 1e-6.
Leaves leavingRays(uint32_t triangles, uint32_t rays, bool placed, uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1), exponent(-8, 8), share(0, 1);
  Leaves leaves;
  for (uint32_t k = 0; k < triangles; ++k) {
    const auto coordinate = [&] { return static_cast<float>(unit(random) * std::pow(10.0, exponent(random))); };
    LeaveCase c{};
    for (glm::vec3* v : {&c.v0, &c.v1, &c.v2}) *v = {coordinate(), coordinate(), coordinate()};
    glm::dmat4 placement(1);
    if (placed) placement = test::randomPlacement(random, std::pow(10.0, exponent(random)));
    setRows(placement, c.worldFromObject);
    setRows(glm::inverse(placement), c.objectFromWorld);
    const glm::dmat3 linear(placement);
    const glm::dvec3 e1 = linear * (glm::dvec3(c.v1) - glm::dvec3(c.v0));
    const glm::dvec3 e2 = linear * (glm::dvec3(c.v2) - glm::dvec3(c.v0));
    const glm::dvec3 n = glm::normalize(glm::cross(glm::normalize(e1), glm::normalize(e2)));
    for (uint32_t i = 0; i < rays; ++i) {
      double b1 = share(random), b2 = share(random);
      if (b1 + b2 > 1) b1 = 1 - b1, b2 = 1 - b2;
      c.barycentrics = {b1, b2};
      c.direction = test::randomDirection(random);
      if (std::abs(glm::dot(n, glm::dvec3(c.direction))) < 1e-3) continue;
      leaves.cases.push_back(c);
      leaves.placements.push_back(placement);
    }
  }
  return leaves;
}

std::vector<LeaveResult> leave(const std::vector<LeaveCase>& cases) {
  return test::runProbe<LeaveCase, LeaveResult>(test_glsl_kernels::kernelSource("offset_leave_probe"), cases);
}

} // namespace

TEST(RayOffset, EqualsTheReferenceBitForBit) {
  std::mt19937 random(43);
  std::uniform_real_distribution<double> unit(-1, 1), exponent(-10, 10);
  const float special[] = {0.0f,   -0.0f, 1 / 32.0f, -1 / 32.0f,  1e30f,
                           -1e30f, 1.0f,  -1.0f,     16777216.0f, 1.17549435e-38f};
  std::vector<OffsetCase> cases;
  for (uint32_t i = 0; i < 1000000; ++i) {
    const auto coordinate = [&] {
      return random() % 4 == 0 ? special[random() % std::size(special)]
                               : static_cast<float>(unit(random) * std::pow(10.0, exponent(random)));
    };
    OffsetCase c{};
    c.p = {coordinate(), coordinate(), coordinate()};
    c.pError = glm::abs(c.p) * 1e-6f;
    if (i % 8 == 0) c.pError = glm::vec3(0);
    c.ng = i % 16 == 1 ? glm::vec3(0, i % 32 == 1 ? 1 : -1, 0) : test::randomDirection(random);
    c.w = test::randomDirection(random);
    // The side is decided by a float dot product: no case where its rounding could matter.
    if (std::abs(glm::dot(c.w, c.ng)) > 1e-5f) cases.push_back(c);
  }
  const auto results = test::runProbe<OffsetCase, OffsetResult>(test_glsl_kernels::kernelSource("offset_probe"), cases);
  size_t different = 0;
  for (size_t i = 0; i < cases.size(); ++i) different += !sameBits(results[i].origin, referenceOrigin(cases[i]));
  EXPECT_EQ(different, 0u);
}

TEST(RayOffset, TheFixedOneIsTheSameEverywhere) {
  const gpu::SpecConstant fixed[] = {{setting_id::kRayOffset, static_cast<uint32_t>(isophote::RayOffset::Fixed)}};
  std::mt19937 random(44);
  std::vector<OffsetCase> cases(1000);
  for (OffsetCase& c : cases) {
    c.p = test::randomDirection(random);
    c.pError = glm::vec3(1e-3f);
    c.ng = test::randomDirection(random);
    c.w = test::randomDirection(random);
  }
  const auto results =
      test::runProbe<OffsetCase, OffsetResult>(test_glsl_kernels::kernelSource("offset_probe"), cases, 0, fixed);
  for (size_t i = 0; i < cases.size(); ++i) {
    const glm::vec3 moved = results[i].origin - cases[i].p;
    ASSERT_NEAR(glm::length(moved), 1e-4, 2e-7); // roundings of coordinates up to 1
    ASSERT_GE(glm::dot(moved, cases[i].ng) * glm::dot(cases[i].w, cases[i].ng), 0);
  }
}

TEST(RayOffset, NoRayMeetsTheTriangleItLeaves) {
  const Leaves leaves = leavingRays(1000, 1000, false, 41);
  size_t selfHits = 0;
  for (const LeaveResult& result : leave(leaves.cases)) selfHits += result.found;
  EXPECT_EQ(selfHits, 0u);
  EXPECT_GT(leaves.cases.size(), 900000u);
}

TEST(RayOffset, NoRayMeetsThePlacedTriangleItLeaves) {
  const Leaves leaves = leavingRays(2000, 200, true, 42);
  size_t selfHits = 0;
  for (const LeaveResult& result : leave(leaves.cases)) selfHits += result.found;
  EXPECT_EQ(selfHits, 0u);
}

// Number 41, the other half: a ray that leaves in reflection or in transmission does not start beyond what lies next to
// the surface it leaves. A copy of the triangle is moved along its normal, to the side the ray goes to, by 1e-5 of its
// largest coordinate: an offset of 84 roundings, where the error bound is of at most 13, twice. Both sides of 1000
// triangles, 100 rays each within 60 degrees of the normal.
TEST(RayOffset, Test41NoRayLosesANeighborOnEitherSide) {
  Leaves leaves = leavingRays(1000, 100, false, 46);
  std::vector<LeaveCase> cases;
  size_t reflected = 0;
  std::mt19937 random(47);
  for (LeaveCase c : leaves.cases) {
    const glm::dvec3 v0(c.v0), e1 = glm::dvec3(c.v1) - v0, e2 = glm::dvec3(c.v2) - v0;
    glm::dvec3 normal = glm::normalize(glm::cross(glm::normalize(e1), glm::normalize(e2)));
    double largest = 0;
    for (const glm::vec3& v : {c.v0, c.v1, c.v2})
      largest = std::max({largest, double(std::abs(v.x)), double(std::abs(v.y)), double(std::abs(v.z))});
    if (random() % 2 == 0) normal = -normal;
    const double gap = 1e-5 * largest;
    // The copy must be where it was meant to be, and the ray must not leave the prism between the two: triangles that
    // are wider than a few gaps, points away from their edges.
    const double b1 = c.barycentrics.x, b2 = c.barycentrics.y;
    const double height = glm::length(glm::cross(e1, e2)) /
                          std::max({glm::length(e1), glm::length(e2), glm::length(e2 - e1)}); // the smallest
    if (std::min({b1, b2, 1 - b1 - b2}) * height < 4 * gap) continue;
    glm::dvec3 direction = glm::dvec3(c.direction);
    if (glm::dot(direction, normal) < 0) direction = -direction;
    if (glm::dot(direction, normal) < 0.5) continue;
    c.direction = direction;
    c.neighbor = gap * normal;
    reflected += glm::dot(glm::cross(glm::normalize(e1), glm::normalize(e2)), direction) > 0;
    cases.push_back(c);
  }
  EXPECT_GT(reflected, 10000u);
  EXPECT_GT(cases.size() - reflected, 10000u);
  size_t lost = 0, selfHits = 0;
  for (const LeaveResult& result : leave(cases)) {
    lost += result.neighborFound == 0;
    selfHits += result.found;
  }
  EXPECT_EQ(lost, 0u);
  EXPECT_EQ(selfHits, 0u);
}

TEST(RayOffset, ErrorBoundsHoldTheExactPoint) {
  const Leaves leaves = leavingRays(20000, 10, true, 44);
  const std::vector<LeaveResult> results = leave(leaves.cases);
  for (size_t i = 0; i < results.size(); ++i) {
    const LeaveCase& c = leaves.cases[i];
    const glm::dvec3 v0(c.v0), v1(c.v1), v2(c.v2);
    const glm::dvec3 object = v0 + double(c.barycentrics.x) * (v1 - v0) + double(c.barycentrics.y) * (v2 - v0);
    const glm::dvec3 world(leaves.placements[i] * glm::dvec4(object, 1));
    for (int axis = 0; axis < 3; ++axis) {
      ASSERT_LE(std::abs(object[axis] - results[i].pObject[axis]), results[i].pErrorObject[axis]) << i;
      ASSERT_LE(std::abs(world[axis] - results[i].p[axis]), results[i].pError[axis]) << i;
      // And they are no more than some roundings of the coordinates that enter.
      const double size = std::abs(v0[axis]) + std::abs(v1[axis]) + std::abs(v2[axis]);
      ASSERT_LE(results[i].pErrorObject[axis], 1.5e-6 * size) << i;
    }
  }
}

TEST(RayOffset, RaysStartOnTheirSideOfThePlane) {
  // Also after the trip through world space, decided in double.
  const Leaves leaves = leavingRays(20000, 10, true, 45);
  const std::vector<LeaveResult> results = leave(leaves.cases);
  for (size_t i = 0; i < results.size(); ++i) {
    const LeaveCase& c = leaves.cases[i];
    const glm::dvec3 v0(c.v0);
    const glm::dvec3 n = glm::cross(glm::normalize(glm::dvec3(c.v1) - v0), glm::normalize(glm::dvec3(c.v2) - v0));
    const double height = glm::dot(n, glm::dvec3(results[i].originObject) - v0);
    const double side = glm::dot(n, glm::inverse(glm::dmat3(leaves.placements[i])) * glm::dvec3(c.direction));
    ASSERT_GT(height * (side < 0 ? -1 : 1), 0) << i;
  }
}
