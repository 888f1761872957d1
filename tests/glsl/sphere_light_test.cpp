#include "glsl/sphere_light_case.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "render/setting_ids.hpp"
#include "support/probe.hpp"
#include "support/statistics.hpp"
#include "test_glsl_kernels.hpp"

namespace isophote {
namespace {

using gpu::SphereLightCase;
using gpu::SphereLightResult;

constexpr double kPi = std::numbers::pi;
// kSphereLightSampling in shared/settings.inc.
constexpr gpu::SpecConstant kCone{setting_id::kSphereLightSampling, 0};
constexpr gpu::SpecConstant kArea{setting_id::kSphereLightSampling, 1};

std::vector<SphereLightResult> run(const std::vector<SphereLightCase>& cases, gpu::SpecConstant sampling = kCone) {
  const gpu::SpecConstant constants[] = {sampling};
  return test::runProbe<SphereLightCase, SphereLightResult>(test_glsl_kernels::kernelSource("sphere_light_probe"),
                                                            cases, 0, constants);
}

struct Setting {
  glm::vec3 center;
  float radius;
  glm::vec3 p;
};

/// Near, nearly touching, far, and from inside.
const Setting kSettings[] = {{{0, 2, 0}, 1, {0, 0, 0}},
                             {{1, 1, -2}, 0.7f, {0.2f, 0.7f, -2}},
                             {{5, -40, 3}, 0.2f, {0, 1, 0}},
                             {{0, 0, 0}, 2, {0.4f, -1.1f, 0.8f}}};

std::vector<SphereLightCase> sampleCases(const Setting& setting, uint32_t count) {
  std::mt19937 generator(24);
  const auto lattice = [&] { return std::ldexp(static_cast<float>(generator() >> 8), -24); };
  std::vector<SphereLightCase> cases(count);
  for (auto& c : cases) {
    c = {setting.center, setting.radius, setting.p, {}, {0, 0, 1}};
    c.u.x = lattice();
    c.u.y = lattice();
  }
  return cases;
}

/// Solid angle of a sphere (2 pi (1 - cos)), or of everything from inside.
double solidAngle(const Setting& setting) {
  const double d = glm::length(glm::dvec3(setting.center) - glm::dvec3(setting.p));
  if (d <= setting.radius) return 4 * kPi;
  const double sine = setting.radius / d;
  return 2 * kPi * sine * sine / (1 + std::sqrt(1 - sine * sine));
}

TEST(SphereLight, SamplesLieOnTheSphereWhereTheirDirectionMeetsIt) {
  for (const auto sampling : {kCone, kArea}) {
    for (const Setting& setting : kSettings) {
      const auto cases = sampleCases(setting, 20'000);
      const auto results = run(cases, sampling);
      const glm::dvec3 center(setting.center), p(setting.p);
      const double r = setting.radius, d = glm::length(center - p);
      for (size_t i = 0; i < cases.size(); ++i) {
        const auto& s = results[i];
        if (s.pdf == 0) continue;
        ASSERT_NEAR(glm::length(glm::dvec3(s.normal)), 1, 2e-6) << i;
        ASSERT_NEAR(glm::length(glm::dvec3(s.wi)), 1, 1e-6) << i;
        const glm::dvec3 point = center + r * glm::dvec3(s.normal);
        const glm::dvec3 reached = p + glm::dvec3(s.wi) * glm::length(point - p);
        ASSERT_LT(glm::length(point - reached), 2e-6 * (r + d)) << i;
        ASSERT_NEAR(s.distance, glm::length(point - p), 3e-6 * (r + d)) << i;
        if (d > r) {
          ASSERT_LT(glm::dot(glm::dvec3(s.normal), glm::dvec3(s.wi)), 1e-5) << i; // the near side
        }
      }
    }
  }
}

TEST(SphereLight, ARayThatHitsIsToldTheDensityThatSamplingHad) {
  for (const auto sampling : {kCone, kArea}) {
    for (const Setting& setting : kSettings) {
      const auto cases = sampleCases(setting, 20'000);
      const auto results = run(cases, sampling);
      const double d = glm::length(glm::dvec3(setting.center) - glm::dvec3(setting.p));
      for (size_t i = 0; i < cases.size(); ++i) {
        const auto& s = results[i];
        if (s.pdf == 0) continue;
        // Towards the limb the cosine, and with it the area's density, loses what the direction's rounding moves.
        const double cosine = std::abs(glm::dot(glm::dvec3(s.normal), glm::dvec3(s.wi)));
        if (sampling.value == kArea.value && cosine < 0.05) continue;
        const double tolerance =
            sampling.value == kCone.value ? 1e-6 : 3e-6 * (1 + d / setting.radius) / (cosine * cosine);
        ASSERT_NEAR(s.hitPdf / s.pdf, 1, tolerance) << i << " cosine " << cosine;
      }
    }
  }
}

TEST(SphereLight, ConeDensityIsOneOverTheSolidAngleAtAnyDistance) {
  for (const double ratio : {1.001, 1.5, 10.0, 1e3, 1e4, 1e6, 1e9}) {
    const Setting setting{{0, static_cast<float>(ratio), 0}, 1, {0, 0, 0}};
    for (const auto& s : run(sampleCases(setting, 100))) ASSERT_NEAR(s.pdf * solidAngle(setting), 1, 2e-6) << ratio;
  }
}

// The mean of 1 / pdf over the samples is the sphere's solid angle: no probability is lost or counted twice. 1e6
// samples by area: half width below 3%.
TEST(SphereLight, AreaDensityIntegratesToOne) {
  const double level = test::sidak(0.001, std::size(kSettings));
  for (const Setting& setting : kSettings) {
    test::Moments inverse;
    for (const auto& s : run(sampleCases(setting, 1'000'000), kArea)) inverse.add(s.pdf > 0 ? 1.0 / s.pdf : 0.0);
    EXPECT_GT(test::meanTest(inverse, solidAngle(setting)), level) << inverse.mean() << " " << solidAngle(setting);
    EXPECT_LT(test::normalTwoSidedQuantile(level) * inverse.standardError(), 0.03 * solidAngle(setting));
  }
}

/// Bins of equal solid angle over the cone: 16 in the cosine, 16 in the azimuth. 1e6 samples.
TEST(SphereLight, DirectionsFollowTheirDensity) {
  constexpr size_t kRows = 16, kColumns = 16;
  constexpr uint32_t kSamples = 1'000'000;
  const double level = test::sidak(0.001, 2 * std::size(kSettings));
  for (const auto sampling : {kCone, kArea}) {
    for (const Setting& setting : kSettings) {
      const glm::dvec3 toCenter = glm::dvec3(setting.center) - glm::dvec3(setting.p);
      const double d = glm::length(toCenter), r = setting.radius;
      const glm::dvec3 axis = toCenter / d;
      const glm::dvec3 s = glm::normalize(glm::cross(axis, glm::dvec3(0.3, 0.5, 0.8))), t = glm::cross(axis, s);
      const double oneMinusCosMax = solidAngle(setting) / (2 * kPi);
      // Share of the samples within an angle of the axis; by area that of the sphere's zone seen there (Archimedes: its
      // height over the diameter).
      const auto shareBelow = [&](double oneMinusCos) {
        if (sampling.value == kCone.value) return oneMinusCos / oneMinusCosMax;
        const double cosine = 1 - oneMinusCos, sine2 = oneMinusCos * (2 - oneMinusCos);
        const double chord = std::sqrt(std::max(r * r - d * d * sine2, 0.0));
        const double reach = d * cosine + (d > r ? -chord : chord); // distance to the point
        const double height = (reach * cosine - d) / r;             // of the point over the center, along the axis
        return 0.5 * (d > r ? 1 + height : 1 - height);
      };
      std::vector<uint64_t> observed(kRows * kColumns, 0);
      std::vector<double> expected(observed.size());
      uint64_t unseen = 0;
      for (const auto& result : run(sampleCases(setting, kSamples), sampling)) {
        if (result.pdf == 0) {
          ++unseen;
          continue;
        }
        const glm::dvec3 wi = glm::normalize(glm::dvec3(result.wi));
        const glm::dvec3 chord = wi - axis;
        const double row = 0.5 * glm::dot(chord, chord) / oneMinusCosMax * kRows;
        const double column = (std::atan2(glm::dot(wi, t), glm::dot(wi, s)) / (2 * kPi) + 0.5) * kColumns;
        const auto bin = [](double x, size_t count) {
          return std::min(static_cast<size_t>(std::max(x, 0.0)), count - 1);
        };
        ++observed[bin(row, kRows) * kColumns + bin(column, kColumns)];
      }
      for (size_t i = 0; i < observed.size(); ++i) {
        const size_t row = i / kColumns;
        const double share = shareBelow(oneMinusCosMax * static_cast<double>(row + 1) / kRows) -
                             shareBelow(oneMinusCosMax * static_cast<double>(row) / kRows);
        expected[i] = kSamples * share / kColumns;
      }
      observed.push_back(unseen);
      expected.push_back(kSamples * (1 - shareBelow(oneMinusCosMax)));
      const auto result = test::chiSquareTest(observed, expected);
      EXPECT_GT(result.p, level) << "sampling " << sampling.value << " distance " << d << " stray " << result.stray;
    }
  }
}

// Rays past the limb by 1% of the radius miss and rays within it by 1% hit, up to where the direction's own rounding,
// 6e-8 of the distance, is that large; distances match double.
TEST(SphereLight, RaysHitSpheresHoweverFarTheyAre) {
  std::mt19937 generator(69);
  std::uniform_real_distribution<double> unit(0, 1);
  for (const double ratio : {1.5, 10.0, 1e2, 1e3, 1e4, 3e4}) {
    std::vector<SphereLightCase> cases;
    std::vector<bool> meets;
    for (int i = 0; i < 5000; ++i) {
      const bool meet = i % 2 == 0;
      const double r = std::exp2(20 * unit(generator) - 10), phi = 2 * kPi * unit(generator);
      const double z = 2 * unit(generator) - 1;
      const glm::vec3 axis(static_cast<float>(std::sqrt(1 - z * z) * std::cos(phi)),
                           static_cast<float>(std::sqrt(1 - z * z) * std::sin(phi)), static_cast<float>(z));
      SphereLightCase c{};
      c.radius = static_cast<float>(r);
      c.p = static_cast<float>(r) * glm::vec3(0.3f, -0.2f, 0.1f);
      c.center = c.p + static_cast<float>(ratio * r) * axis;
      const glm::dvec3 toCenter = glm::dvec3(c.center) - glm::dvec3(c.p);
      const glm::dvec3 across = glm::normalize(glm::cross(toCenter, glm::dvec3(unit(generator), unit(generator), 2)));
      const double d = glm::length(toCenter);
      const double sine = c.radius * (meet ? 0.99 * std::sqrt(unit(generator)) : 1.01) / d;
      const glm::dvec3 direction = std::sqrt(1 - sine * sine) * toCenter / d + sine * across;
      c.direction = glm::vec3(std::exp2(8 * unit(generator) - 4) * direction);
      cases.push_back(c);
      meets.push_back(meet);
    }
    const auto results = run(cases);
    for (size_t i = 0; i < cases.size(); ++i) {
      ASSERT_EQ(results[i].found == 1, meets[i]) << ratio << " " << i;
      if (!meets[i]) continue;
      const glm::dvec3 o = glm::dvec3(cases[i].p) - glm::dvec3(cases[i].center), w(cases[i].direction);
      const double a = glm::dot(w, w), b = glm::dot(o, w);
      const double r = cases[i].radius;
      const double root = std::sqrt(std::max(b * b - a * (glm::dot(o, o) - r * r), 0.0));
      ASSERT_NEAR(results[i].t * std::sqrt(a) / r, (-b - root) / std::sqrt(a) / r, 1e-5 * ratio) << ratio << " " << i;
    }
  }
}

} // namespace
} // namespace isophote
