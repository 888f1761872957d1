// The textbook's ways of drawing a direction: each draws what its density says, and each estimates the same integral.
#include <numbers>

#include <gtest/gtest.h>

#include "glsl/bsdf_material_cases.hpp"
#include "glsl/direction_sampling_case.h"
#include "isophote/settings.hpp"
#include "render/setting_ids.hpp"
#include "support/statistics.hpp"

using namespace isophote;
using gpu::DirectionCase;
using gpu::DirectionResult;
using std::numbers::pi;

namespace {

constexpr DirectionSampling kTechniques[] = {DirectionSampling::Lobes,          DirectionSampling::Uniform,
                                             DirectionSampling::Cosine,         DirectionSampling::Ndf,
                                             DirectionSampling::VisibleNormals, DirectionSampling::Mixture};

std::vector<DirectionResult> probe(const std::vector<DirectionCase>& cases, DirectionSampling technique,
                                   Ndf ndf = Ndf::Ggx) {
  EstimatorSettings settings;
  settings.ndf = ndf;
  const test::BsdfScene scene({.facets = true}, settings);
  const gpu::SpecConstant constants[] = {{setting_id::kDirectionSampling, static_cast<uint32_t>(technique)},
                                         {setting_id::kNdf, static_cast<uint32_t>(ndf)}};
  return test::runProbe<DirectionCase, DirectionResult>(test_glsl_kernels::kernelSource("direction_sampling_probe"),
                                                        cases, scene.address(), constants);
}

DirectionCase material(float metallic, float alpha, float glass = 0) {
  return {.baseColor = {0.9f, 0.6f, 0.3f},
          .metallic = metallic,
          .roughness = std::sqrt(alpha),
          .glass = glass,
          .wo = {0, 0, 1},
          .wi = {0, 0, 1},
          .uLobe = 0.5f,
          .u = {0.5f, 0.5f}};
}

/// Bins of equal solid angle over the sphere: height and azimuth.
struct SphereGrid {
  static constexpr int kHeights = 20;
  static constexpr int kTurns = 12;
  static constexpr int kNodes = 12; // midpoints a bin and axis
  static constexpr size_t kBins = kHeights * kTurns;

  static size_t binOf(glm::dvec3 w) {
    const double turn = std::atan2(w.y, w.x) / (2 * pi) + 0.5;
    const int height = std::min(int((w.z + 1) / 2 * kHeights), kHeights - 1);
    return size_t(height * kTurns + std::min(int(turn * kTurns), kTurns - 1));
  }

  static glm::dvec3 node(int i, int j) {
    const double z = 2 * (i + 0.5) / (kHeights * kNodes) - 1;
    const double phi = 2 * pi * ((j + 0.5) / (kTurns * kNodes) - 0.5);
    const double r = std::sqrt(1 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
  }
  static constexpr double kNodeSolidAngle = 4 * pi / (double(kBins) * kNodes * kNodes);
};

std::vector<DirectionCase> draws(const DirectionCase& material, size_t count, uint32_t seed) {
  std::mt19937 generator(seed);
  std::vector<DirectionCase> cases(count, material);
  for (DirectionCase& c : cases) {
    c.uLobe = test::uniform(generator);
    c.u.x = test::uniform(generator);
    c.u.y = test::uniform(generator);
  }
  return cases;
}

/// D cos / (4 wo.wm) for all normals, and for visible ones, in double. Walter et al. 2007, eq. 33; Heitz 2014, eq. 16.
double reflectedNormalDensity(glm::dvec3 wo, glm::dvec3 wi, double alpha, bool visibleOnly) {
  const glm::dvec3 wm = glm::normalize(wo + wi);
  const double cosine2 = wm.z * wm.z;
  const double tangent2 = (1 - cosine2) / cosine2;
  const double d = alpha * alpha / (pi * cosine2 * cosine2 * std::pow(alpha * alpha + tangent2, 2));
  if (!visibleOnly) return d * wm.z / (4 * glm::dot(wo, wm));
  const double tangentO2 = (1 - wo.z * wo.z) / (wo.z * wo.z);
  const double g1 = 2 / (1 + std::sqrt(1 + alpha * alpha * tangentO2)); // eq. 34
  return d * g1 / (4 * wo.z);
}

double expectedDensity(DirectionSampling technique, glm::dvec3 wo, glm::dvec3 wi, double alpha) {
  switch (technique) {
  case DirectionSampling::Uniform:
    return 1 / (2 * pi);
  case DirectionSampling::Cosine:
    return wi.z / pi;
  case DirectionSampling::Ndf:
    return reflectedNormalDensity(wo, wi, alpha, false);
  case DirectionSampling::VisibleNormals:
    return reflectedNormalDensity(wo, wi, alpha, true);
  default:
    return (1 / (2 * pi) + wi.z / pi + reflectedNormalDensity(wo, wi, alpha, false) +
            reflectedNormalDensity(wo, wi, alpha, true)) /
           4;
  }
}

} // namespace

// Densities against double precision, on a surface that a technique draws alone and on one where it has half.
TEST(DirectionSampling, DensitiesAreThoseOfTheTextbook) {
  std::mt19937 generator(7);
  for (const float glass : {0.0f, 1.0f}) {
    std::vector<DirectionCase> cases;
    for (int i = 0; i < 2000; ++i) {
      DirectionCase c = material(0, std::pow(10.0f, -2 * test::uniform(generator)), glass);
      c.wo = test::directionOf(0.02 + 0.98 * double(test::uniform(generator)), 1);
      c.wi = test::directionOf(0.02 + 0.98 * double(test::uniform(generator)), 6 * double(test::uniform(generator)));
      cases.push_back(c);
    }
    for (const DirectionSampling technique : kTechniques) {
      const std::vector<DirectionResult> results = probe(cases, technique);
      for (size_t i = 0; i < cases.size(); ++i) {
        double expected = double(results[i].pdfLobes);
        if (technique != DirectionSampling::Lobes) {
          const double alpha = double(cases[i].roughness) * double(cases[i].roughness);
          const double alone = expectedDensity(technique, glm::dvec3(cases[i].wo), glm::dvec3(cases[i].wi), alpha);
          expected = glass > 0 ? (expected + alone) / 2 : alone;
        }
        // The normal's tangent is known to 1e-7 / alpha, and the density is its square's fourth power at most.
        EXPECT_NEAR(double(results[i].pdf), expected, 1e-4 * expected) << uint32_t(technique) << ", case " << i;
      }
    }
  }
}

namespace {

constexpr size_t kDraws = 40000;

/// 4e4 samples in 240 bins: a density off by 5% root mean square is rejected; its integral and the absorbed share make
/// 1 within 1e-2.
void expectSamplesFollowDensity(const DirectionCase& base, DirectionSampling technique, Ndf ndf, uint32_t seed,
                                double significance) {
  std::vector<DirectionCase> cases = draws(base, kDraws, seed);
  for (int i = 0; i < SphereGrid::kHeights * SphereGrid::kNodes; ++i) {
    for (int j = 0; j < SphereGrid::kTurns * SphereGrid::kNodes; ++j) {
      cases.push_back(base);
      cases.back().wi = glm::vec3(SphereGrid::node(i, j));
    }
  }
  const std::vector<DirectionResult> results = probe(cases, technique, ndf);
  std::vector<uint64_t> observed(SphereGrid::kBins + 1);
  std::vector<double> expected(SphereGrid::kBins + 1);
  for (size_t i = 0; i < kDraws; ++i) {
    const bool isValid = (results[i].flags & gpu::kDirectionValid) != 0;
    ++observed[isValid ? SphereGrid::binOf(glm::dvec3(results[i].sampledWi)) : SphereGrid::kBins];
  }
  double mass = 0;
  for (size_t i = kDraws; i < cases.size(); ++i) {
    const double probability = double(results[i].pdf) * SphereGrid::kNodeSolidAngle;
    expected[SphereGrid::binOf(glm::dvec3(cases[i].wi))] += double(kDraws) * probability;
    mass += probability;
  }
  const double absorbed = double(observed[SphereGrid::kBins]) / double(kDraws);
  EXPECT_NEAR(mass + absorbed, 1, 1e-2);
  expected[SphereGrid::kBins] = double(kDraws) * std::max(1 - mass, 0.0);
  EXPECT_GT(test::chiSquareTest(observed, expected).p, significance);
}

} // namespace

// Significance 1e-3 over all configurations (Sidak).
TEST(DirectionSampling, SamplesFollowTheDensityWhichIntegratesToOne) {
  struct Surface {
    const char* name;
    DirectionCase material;
  };
  const Surface surfaces[] = {
      {"metal", material(1, 0.4f)}, {"dielectric", material(0, 0.25f)}, {"glass", material(0, 0.4f, 1)}};
  const double significance = test::sidak(1e-3, std::size(kTechniques) * std::size(surfaces));
  uint32_t seed = 1;
  for (const DirectionSampling technique : kTechniques) {
    for (const Surface& surface : surfaces) {
      SCOPED_TRACE(testing::Message() << surface.name << ", technique " << uint32_t(technique));
      DirectionCase base = surface.material;
      base.wo = test::directionOf(0.5, 0.6);
      expectSamplesFollowDensity(base, technique, Ndf::Ggx, seed++, significance);
    }
  }
}

// By lobes too: the choice between a facet and its mirror image leaves a uniform number for that between reflection and
// transmission. Half glass, so that every choice is made.
TEST(DirectionSampling, SamplesOfOtherFacetsFollowTheDensity) {
  const std::pair<Ndf, DirectionSampling> choices[] = {{Ndf::BlinnPhong, DirectionSampling::Lobes},
                                                       {Ndf::Beckmann, DirectionSampling::Mixture}};
  const double significance = test::sidak(1e-3, std::size(choices));
  uint32_t seed = 50;
  for (const auto& [ndf, technique] : choices) {
    SCOPED_TRACE(testing::Message() << "ndf " << uint32_t(ndf) << ", technique " << uint32_t(technique));
    DirectionCase base = material(0, 0.5f, 0.5f);
    base.wo = test::directionOf(0.3, 0.6);
    expectSamplesFollowDensity(base, technique, ndf, seed++, significance);
  }
}

// Narrow facets reach the diffuse lobe's directions by their lobes alone: known to 2%.
TEST(DirectionSampling, NormalsOfOtherFacetsMissNothing) {
  for (const Ndf ndf : {Ndf::Beckmann, Ndf::BlinnPhong}) {
    DirectionCase plastic = material(0, 0.04f);
    plastic.wo = test::directionOf(0.5, 0.6);
    test::Moments reference;
    for (const auto technique : {DirectionSampling::Lobes, DirectionSampling::Ndf, DirectionSampling::VisibleNormals}) {
      SCOPED_TRACE(testing::Message() << "ndf " << uint32_t(ndf) << ", technique " << uint32_t(technique));
      test::Moments moments;
      for (const DirectionResult& result : probe(draws(plastic, 50000, 7 + uint32_t(technique)), technique, ndf)) {
        moments.add((result.flags & gpu::kDirectionValid) != 0 ? double(result.weight.y) : 0);
      }
      EXPECT_LT(moments.standardError(), 0.01 * moments.mean());
      if (technique == DirectionSampling::Lobes) reference = moments;
      EXPECT_GT(test::welchTest(moments, reference), 1e-4) << moments.mean() << " is not " << reference.mean();
    }
  }
}

// The reflected share of uniform light, by every technique: the same expectation (significance 1e-3 over the family),
// known to 2% or better.
TEST(DirectionSampling, EveryTechniqueEstimatesTheSameAlbedoSlow) {
  const DirectionCase surfaces[] = {material(1, 0.4f), material(0, 0.25f), material(0.5f, 1e-5f), material(0, 0.4f, 1),
                                    material(0, 0, 0.5f)};
  const double significance = test::sidak(1e-3, std::size(surfaces) * (std::size(kTechniques) - 1));
  for (const DirectionCase& surface : surfaces) {
    DirectionCase base = surface;
    base.wo = test::directionOf(0.5, 0.6);
    test::Moments reference;
    for (const DirectionSampling technique : kTechniques) {
      SCOPED_TRACE(testing::Message() << "technique " << uint32_t(technique) << ", metallic " << base.metallic
                                      << ", roughness " << base.roughness << ", glass " << base.glass);
      test::Moments moments;
      for (const DirectionResult& result : probe(draws(base, 200000, 3 + uint32_t(technique)), technique)) {
        moments.add((result.flags & gpu::kDirectionValid) != 0 ? double(result.weight.y) : 0);
      }
      EXPECT_LT(moments.standardError(), 0.02 * moments.mean());
      if (technique == DirectionSampling::Lobes) {
        reference = moments;
      } else {
        EXPECT_GT(test::welchTest(moments, reference), significance)
            << moments.mean() << " is not " << reference.mean();
      }
    }
  }
}

TEST(DirectionSampling, SampleWeightIsValueOverDensity) {
  for (const DirectionSampling technique : kTechniques) {
    for (const float glass : {0.0f, 1.0f}) {
      const auto cases = draws(material(0, 0.2f, glass), 2000, 5);
      for (const DirectionResult& result : probe(cases, technique)) {
        const bool isContinuous =
            (result.flags & (gpu::kDirectionValid | gpu::kDirectionDelta)) == gpu::kDirectionValid;
        if (!isContinuous) continue;
        EXPECT_NEAR(result.sampledPdf, result.pdfAtSampled, 1e-4 * double(result.pdfAtSampled));
        EXPECT_NEAR(double(result.weight.y * result.pdfAtSampled), double(result.fCosSampled.y),
                    1e-4 * double(result.fCosSampled.y));
      }
    }
  }
}
