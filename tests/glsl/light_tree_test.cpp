#include "glsl/light_tree_case.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "accel/light_tree.hpp"
#include "glsl/light_scene.hpp"
#include "oracle/light_tree.hpp"
#include "support/probe.hpp"
#include "support/statistics.hpp"
#include "test_glsl_kernels.hpp"

namespace isophote {
namespace {

using gpu::LightTreeCase;
using gpu::LightTreeResult;

constexpr double kPi = 3.14159265358979323846;

struct Emitter {
  std::array<glm::dvec3, 3> corners{}; // of a triangle; a point where all are equal
  LightBound bound;
};

glm::dvec3 randomUnit(std::mt19937& generator) {
  std::normal_distribution<double> normal;
  return glm::normalize(glm::dvec3(normal(generator), normal(generator), normal(generator)));
}

Emitter triangle(const std::array<glm::dvec3, 3>& v, bool twoSided, double radiance) {
  Emitter emitter{v, {}};
  const glm::dvec3 normal = glm::cross(v[1] - v[0], v[2] - v[0]);
  emitter.bound = {.lower = glm::min(v[0], glm::min(v[1], v[2])),
                   .upper = glm::max(v[0], glm::max(v[1], v[2])),
                   .axis = glm::normalize(normal),
                   .thetaO = 0,
                   .thetaE = kPi / 2,
                   .twoSided = twoSided,
                   .intensity = 0.5 * glm::length(normal) * radiance};
  emitter.bound.power = (twoSided ? 2 : 1) * kPi * emitter.bound.intensity;
  return emitter;
}

Emitter point(glm::dvec3 position, double intensity) {
  return {{position, position, position},
          {.lower = position,
           .upper = position,
           .thetaO = kPi,
           .thetaE = kPi / 2,
           .intensity = intensity,
           .power = 4 * kPi * intensity}};
}

Emitter spot(glm::dvec3 position, glm::dvec3 axis, double inner, double outer, double intensity) {
  Emitter emitter = point(position, intensity);
  emitter.bound.axis = axis;
  emitter.bound.thetaO = inner;
  emitter.bound.thetaE = outer - inner;
  return emitter;
}

Emitter infinite(double power) { return {{}, {.infinite = true, .power = power}}; }

/// Triangles of both kinds, points and spots in the unit ball, in clumps, intensities over six decades.
std::vector<Emitter> mixedLights(uint32_t count, uint32_t seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Emitter> lights;
  for (uint32_t i = 0; i < count; ++i) {
    const glm::dvec3 center = randomUnit(generator) * std::cbrt(unit(generator));
    const double intensity = std::pow(10.0, -6 * unit(generator));
    const double size = 0.1 * unit(generator);
    switch (i % 4) {
    case 0:
    case 1: {
      std::array<glm::dvec3, 3> v;
      for (auto& corner : v) corner = center + size * randomUnit(generator);
      lights.push_back(triangle(v, i % 4 == 1, intensity));
      break;
    }
    case 2:
      lights.push_back(point(center, intensity));
      break;
    default:
      lights.push_back(
          spot(center, randomUnit(generator), 0.5 * unit(generator), 0.6 + 0.9 * unit(generator), intensity));
      break;
    }
  }
  return lights;
}

/// A tree on the device.
struct Forest {
  explicit Forest(const std::vector<Emitter>& emitters) {
    for (const Emitter& emitter : emitters) scene.bounds.push_back(emitter.bound);
    tree = buildLightTree(scene.bounds);
  }
  std::vector<LightTreeResult> run(const std::vector<LightTreeCase>& cases) {
    return test::runProbe<LightTreeCase, LightTreeResult>(test_glsl_kernels::kernelSource("light_tree_probe"), cases,
                                                          scene.address());
  }
  test::LightScene scene;
  LightTree tree;
};

std::vector<LightTreeCase> everyLight(uint32_t count, const gpu::LightReceiver& receiver) {
  std::vector<LightTreeCase> cases;
  for (uint32_t i = 0; i < count; ++i) cases.push_back({receiver, {0, 0}, i});
  return cases;
}

double sumOfPmf(const std::vector<LightTreeResult>& results) {
  double sum = 0;
  for (const auto& result : results) sum += static_cast<double>(result.pmfOfLight);
  return sum;
}

// Lights that shine everywhere, so that none is ruled out: the sum is 1 to the rounding of 31 products.
TEST(LightTree, Test54ProbabilitiesOfManyLightsSumToOne) {
  std::mt19937 generator(54);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const double dominant : {1.0, 1e6, 0.0}) {
    std::vector<Emitter> lights;
    for (uint32_t i = 0; i < 100'000; ++i) {
      lights.push_back(point({unit(generator), unit(generator), unit(generator)}, i == 33'333 ? dominant : 1));
    }
    Forest forest(lights);
    const auto results = forest.run(everyLight(100'000, {{0.1f, 0.2f, 0.3f}, {0, 0, 0}}));
    EXPECT_NEAR(sumOfPmf(results), 1, 1e-4);
    const auto [least, most] = std::minmax_element(
        results.begin(), results.end(), [](const auto& a, const auto& b) { return a.pmfOfLight < b.pmfOfLight; });
    if (dominant == 0) {
      EXPECT_EQ(results[33'333].pmfOfLight, 0) << "a light without power";
    } else {
      EXPECT_GT(least->pmfOfLight, 0);
    }
    if (dominant == 1e6) {
      EXPECT_EQ(static_cast<size_t>(most - results.begin()), 33'333u);
      EXPECT_GT(most->pmfOfLight, 0.5f);
    }
  }
}

// 4e5 choices for each of three receivers among 403 lights.
TEST(LightTree, ChoicesFollowTheirProbabilityByChiSquare) {
  auto lights = mixedLights(400, 1);
  for (const double power : {30.0, 0.0, 5.0}) lights.push_back(infinite(power));
  Forest forest(lights);
  std::mt19937 generator(2);
  const gpu::LightReceiver receivers[] = {
      {{0, 0, 0}, {0, 0, 0}}, {{0.3f, -0.2f, 0.5f}, {0, 0.6f, 0.8f}}, {{2, 3, -1}, {-0.6f, -0.8f, 0}}};
  for (const auto& receiver : receivers) {
    std::vector<LightTreeCase> cases(400'000);
    for (auto& c : cases) {
      c = {receiver, {static_cast<uint32_t>(generator()), static_cast<uint32_t>(generator())}, 0};
    }
    std::vector<uint64_t> counts(lights.size() + 1); // the last: none
    for (const auto& result : forest.run(cases)) {
      ASSERT_EQ(result.pmf, result.pmfOfIndex);
      ASSERT_TRUE(result.pmf == 0 || result.index < lights.size());
      ++counts[result.pmf > 0 ? result.index : lights.size()];
    }
    const auto pmf = forest.run(everyLight(static_cast<uint32_t>(lights.size()), receiver));
    std::vector<double> expected;
    for (const auto& result : pmf) expected.push_back(static_cast<double>(result.pmfOfLight) * 400'000);
    expected.push_back(std::max(1 - sumOfPmf(pmf), 0.0) * 400'000);
    if (expected.back() < 1) expected.back() = 0; // rounding
    const auto chi = test::chiSquareTest(counts, expected);
    EXPECT_GT(chi.p, test::sidak(0.001, 3));
    EXPECT_EQ(chi.stray, 0);
  }
}

TEST(LightTree, ProbabilitiesMatchThePapersFormulaInDouble) {
  auto lights = mixedLights(500, 3);
  lights.push_back(infinite(1));
  Forest forest(lights);
  std::mt19937 generator(4);
  std::vector<LightTreeCase> cases;
  for (uint32_t i = 0; i < 20'000; ++i) {
    const glm::dvec3 p = randomUnit(generator) * (0.1 * (i % 30));
    const glm::dvec3 ns = i % 3 == 0 ? glm::dvec3(0) : randomUnit(generator);
    cases.push_back({{glm::vec3(p), glm::vec3(ns)}, {0, 0}, i % static_cast<uint32_t>(lights.size())});
  }
  const auto results = forest.run(cases);
  const double kStep = std::ldexp(2.0, -32); // two of a division's steps
  int possible = 0;
  int atAnEdge = 0; // where rounding decides whether a cluster can contribute
  for (size_t i = 0; i < cases.size(); ++i) {
    const double expected = oracle::lightTreePmf(forest.tree, cases[i].light, glm::dvec3(cases[i].receiver.p),
                                                 glm::dvec3(cases[i].receiver.ns));
    ASSERT_GE(expected, 0);
    const auto actual = static_cast<double>(results[i].pmfOfLight);
    if ((expected > 0) != (actual > 0) || std::abs(actual - expected) > 1e-3 * expected + kStep) {
      ++atAnEdge;
    } else if (expected > 0) {
      ++possible;
    }
  }
  EXPECT_GT(possible, 9'000);
  EXPECT_LE(atAnEdge, 20);
}

/// Whether anything of the light can fall on the receiver.
bool reaches(const Emitter& light, const gpu::LightReceiver& receiver) {
  const glm::dvec3 p(receiver.p);
  for (int i = 0; i <= 10; ++i) {
    for (int j = 0; i + j <= 10; ++j) {
      const auto& v = light.corners;
      const glm::dvec3 toLight = v[0] + 0.1 * i * (v[1] - v[0]) + 0.1 * j * (v[2] - v[0]) - p;
      const bool above = receiver.ns == glm::vec3(0) || glm::dot(toLight, glm::dvec3(receiver.ns)) > 0;
      const double cosine = -glm::dot(glm::normalize(toLight), light.bound.axis);
      const bool lit = light.bound.thetaO >= kPi || (light.bound.twoSided && cosine != 0) ||
                       cosine > std::cos(light.bound.thetaO + light.bound.thetaE);
      if (above && lit) return true;
    }
  }
  return false;
}

// A light that is never chosen though it shines on the receiver would be missing from the image.
TEST(LightTree, EveryLightThatReachesAReceiverCanBeChosen) {
  std::mt19937 generator(6);
  std::uniform_real_distribution<double> unit(0, 1);
  const auto lights = mixedLights(300, 7);
  Forest forest(lights);
  std::vector<LightTreeCase> cases;
  for (uint32_t i = 0; i < 400; ++i) {
    // Near the lights, on their planes, and far.
    const Emitter& near = lights[generator() % lights.size()];
    glm::dvec3 p = near.corners[0] + (near.corners[1] - near.corners[0]) * (3 * unit(generator)) +
                   randomUnit(generator) * std::pow(10.0, -8 * unit(generator));
    if (i % 4 == 0) p = randomUnit(generator) * std::pow(10.0, 6 * unit(generator));
    const glm::dvec3 ns = i % 2 == 0 ? glm::dvec3(0) : randomUnit(generator);
    for (const auto& c : everyLight(300, {glm::vec3(p), glm::vec3(ns)})) cases.push_back(c);
  }
  const auto results = forest.run(cases);
  int reached = 0;
  for (size_t i = 0; i < cases.size(); ++i) {
    if (!reaches(lights[cases[i].light], cases[i].receiver)) continue;
    ASSERT_GT(results[i].pmfOfLight, 0) << "light " << cases[i].light << " case " << i;
    ++reached;
  }
  EXPECT_GT(reached, 30'000);
}

TEST(LightTree, LightsWithoutAPlaceKeepAtLeastAQuarterEach) {
  for (const double power : {1e-9, 1e9}) {
    auto lights = mixedLights(50, 8);
    lights.push_back(infinite(power));
    Forest forest(lights);
    for (const glm::vec3 p : {glm::vec3(0), glm::vec3(1e3f, 0, 0)}) {
      EXPECT_NEAR(forest.run({{{p, glm::vec3(0)}, {0, 0}, 50}})[0].pmfOfLight, power > 1 ? 0.75 : 0.25, 1e-6);
    }
  }
}

TEST(LightTree, OneLightOrNone) {
  Forest one({point({1, 2, 3}, 5)});
  const auto result = one.run({{{{0, 0, 0}, {0, 0, 0}}, {0xffffffffu, 0xffffffffu}, 0}})[0];
  EXPECT_EQ(result.index, 0u);
  EXPECT_EQ(result.pmf, 1);
  EXPECT_TRUE(buildLightTree({}).nodes.empty());
  EXPECT_TRUE(buildLightTree(std::vector<LightBound>{point({0, 0, 0}, 0).bound}).nodes.empty());
}

// Coincident lights cannot be told apart by place: the depth limit must hold all the same.
TEST(LightTree, CoincidentLightsAndExtremeScalesAreDividedEvenly) {
  for (const double scale : {1e-15, 1.0, 1e15}) {
    std::vector<Emitter> lights(5000, point({scale, 0, 0}, 1e20));
    Forest forest(lights);
    const auto results = forest.run(everyLight(5000, {{0, static_cast<float>(scale), 0}, {1, 0, 0}}));
    EXPECT_NEAR(sumOfPmf(results), 1, 1e-4);
    for (const auto& result : results) ASSERT_NEAR(result.pmfOfLight, 1 / 5000.0, 1e-4);
  }
}

} // namespace
} // namespace isophote
