// The diffuse lobe of both sides: values, densities, reciprocity. Its energy: bsdf_furnace_test.cpp.
#include <algorithm>
#include <numbers>

#include <gtest/gtest.h>

#include "glsl/bsdf_material_cases.hpp"
#include "isophote/features.hpp"
#include "support/statistics.hpp"

using namespace isophote;
using gpu::BsdfCase;
using std::numbers::pi;

namespace {

constexpr int kCosines = 80; // of each side
constexpr int kAzimuths = 48;
constexpr double kSolidAngle = 4 * pi / (2 * kCosines * kAzimuths);

// Midpoints of a product grid over the sphere; fine enough for lobes of alpha >= 0.36.
std::vector<BsdfCase> overTheSphere(const BsdfCase& material) {
  std::vector<BsdfCase> cases;
  for (int i = 0; i < 2 * kCosines; ++i) {
    for (int j = 0; j < kAzimuths; ++j) {
      cases.push_back(material);
      cases.back().wi = test::directionOf((i + 0.5) / kCosines - 1, 2 * pi * (j + 0.5) / kAzimuths);
    }
  }
  return cases;
}

BsdfCase lambertLeaf() {
  BsdfCase c = test::leaf(1, 0.4f);
  c.specular = 0;
  return c;
}

BsdfCase halfGlass(test::Side side) {
  BsdfCase c = test::glass(0.7f, side, {0.9f, 0.7f, 0.8f});
  c.transmission = 0.5f;
  c.diffuseTransmission = 0.6f;
  c.diffuseTransmissionColor = {0.2f, 0.8f, 0.4f};
  return c;
}

std::vector<BsdfCase> materials() {
  return {test::leaf(0.6f, 0.3f),          test::leaf(0.8f, 1, glm::vec3(0.5f)), lambertLeaf(),
          halfGlass(test::Side::ThinWall), halfGlass(test::Side::Outside),       halfGlass(test::Side::Inside)};
}

} // namespace

// With neither coat nor facets: the extension's own lines, mix(baseColor / pi above, color / pi behind, factor).
TEST(BsdfDiffuseTransmission, WithoutACoatIsTheExtensionsMixOfLamberts) {
  const BsdfCase leaf = lambertLeaf();
  const auto cases = overTheSphere(leaf);
  const std::vector<gpu::SpecConstant> lambertOnly{{static_cast<uint32_t>(Feature::kHasSpecular), 0},
                                                   {static_cast<uint32_t>(Feature::kHasTransmission), 0}};
  for (const auto& constants : {std::vector<gpu::SpecConstant>{}, lambertOnly}) {
    const auto results = test::probeBsdf(cases, constants);
    for (size_t i = 0; i < cases.size(); ++i) {
      const double z = double(cases[i].wi.z);
      for (int c = 0; c < 3; ++c) {
        const double expected =
            z < 0 ? 0.4 * double(leaf.diffuseTransmissionColor[c]) : 0.6 * double(leaf.baseColor[c]);
        ASSERT_NEAR(double(results[i].fCos[c]), expected * std::abs(z) / pi, 1e-6);
      }
    }
  }
}

TEST(BsdfDiffuseTransmission, ValuesAndDensitiesMatchTheOracleOnBothSides) {
  std::vector<BsdfCase> cases;
  for (BsdfCase material : materials()) {
    for (const double cosine : {1.0, 0.6, 0.1}) {
      material.wo = test::directionOf(cosine, 0.4);
      const auto all = overTheSphere(material);
      for (size_t i = 0; i < all.size(); i += 17) cases.push_back(all[i]);
    }
  }
  const auto results = test::probeBsdf(cases);
  for (size_t i = 0; i < cases.size(); ++i) {
    const BsdfCase& c = cases[i];
    const auto m = test::oracleMaterial(c);
    const glm::dvec3 wo(c.wo), wi(c.wi);
    const glm::dvec3 f = oracle::evalBsdf(m, wo, wi);
    const double pdf = oracle::pdfBsdf(m, wo, wi);
    // The tables of albedo and, seen from inside, of the loss of glass (docs/bsdf.md).
    const double lobe = std::abs(wi.z) / pi * (c.backFace != 0 ? 2.25 : 1.0);
    const double table = c.transmission > 0 ? 1e-2 : std::abs(wi.z) < 0.06 ? 5e-3 : 2e-3;
    for (int k = 0; k < 3; ++k)
      ASSERT_NEAR(double(results[i].fCos[k]), f[k], table * lobe + 1e-3 * f[k]) << test::describe(c);
    ASSERT_NEAR(double(results[i].pdf), pdf, 5e-3 * pdf + table * lobe) << test::describe(c);
  }
}

// f(i -> o) / n_o^2 = f(o -> i) / n_i^2 (Veach 1997, section 5.2), the inner direction's surface seen from the back.
TEST(BsdfDiffuseTransmission, IsReciprocalAcrossTheSurface) {
  std::vector<BsdfCase> there, back;
  for (const BsdfCase& material : materials()) {
    for (int i = 0; i < 200 && material.backFace == 0; ++i) {
      BsdfCase c = material;
      c.wo = test::directionOf(0.05 + 0.0047 * i, 0.4);
      c.wi = test::directionOf(0.99 - 0.0045 * i, 2.1);
      c.wi.z = -c.wi.z;
      there.push_back(c);
      std::swap(c.wo, c.wi); // and the frame turns over
      c.wo.z = -c.wo.z;
      c.wi.z = -c.wi.z;
      c.backFace = c.thinWalled == 0 ? 1 : 0;
      back.push_back(c);
    }
  }
  const auto forward = test::probeBsdf(there);
  const auto backward = test::probeBsdf(back);
  for (size_t i = 0; i < there.size(); ++i) {
    const double n = there[i].thinWalled != 0 ? 1 : double(there[i].ior);
    for (int c = 0; c < 3; ++c) {
      const double a = double(forward[i].fCos[c]) / -double(there[i].wi.z);
      const double b = double(backward[i].fCos[c]) / -double(back[i].wi.z) / (n * n);
      ASSERT_GT(a, 0);
      ASSERT_NEAR(a, b, 4e-4 * a) << test::describe(there[i]);
    }
  }
}

// 20 bins of the cosine on each side, 8 of the azimuth. Significance 1e-3 over the configurations (Sidak); with 4e4
// samples in 320 bins a density that is off by 6% root mean square is rejected, and its integral by 1%.
TEST(BsdfDiffuseTransmission, SamplesFollowTheirDensityByChiSquare) {
  constexpr size_t kSamples = 40'000, kAbsorbed = 320, kNodes = 2 * kCosines * kAzimuths;
  std::mt19937 generator(31);
  std::vector<BsdfCase> cases;
  for (BsdfCase material : materials()) {
    material.wo = test::directionOf(0.7, 0.4);
    for (const BsdfCase& node : overTheSphere(material)) cases.push_back(node);
    for (size_t i = 0; i < kSamples; ++i) test::drawUniforms(cases.emplace_back(material), generator);
  }
  const auto results = test::probeBsdf(cases);
  for (size_t first = 0; first < cases.size(); first += kNodes + kSamples) {
    const auto binOf = [](const glm::vec3& wi) {
      const int row = std::clamp(static_cast<int>((wi.z + 1) * 20), 0, 39);
      const double turn = std::atan2(double(wi.y), double(wi.x)) / (2 * pi);
      return static_cast<size_t>(row * 8 + std::min(static_cast<int>((turn < 0 ? turn + 1 : turn) * 8), 7));
    };
    std::vector<double> expected(kAbsorbed + 1);
    double mass = 0;
    for (size_t i = first; i < first + kNodes; ++i) {
      const double share = double(results[i].pdf) * kSolidAngle;
      expected[binOf(cases[i].wi)] += share * kSamples;
      mass += share;
    }
    expected[kAbsorbed] = std::max(1 - mass, 0.0) * kSamples;
    std::vector<uint64_t> observed(kAbsorbed + 1);
    for (size_t i = first + kNodes; i < first + kNodes + kSamples; ++i) {
      const bool valid = (results[i].flags & gpu::kBsdfValid) != 0;
      ++observed[valid ? binOf(results[i].sampledWi) : kAbsorbed];
      if (!valid) continue;
      ASSERT_NEAR(results[i].sampledPdf, results[i].pdfAtSampled, 1e-4f * results[i].pdfAtSampled);
      for (int c = 0; c < 3; ++c)
        ASSERT_NEAR(results[i].weight[c] * results[i].sampledPdf, results[i].fCosSampled[c],
                    1e-4f * results[i].fCosSampled[c]);
    }
    EXPECT_LT(mass, 1.003);
    const test::ChiSquareResult chi = test::chiSquareTest(observed, expected);
    EXPECT_GT(chi.p, test::sidak(1e-3, materials().size())) << test::describe(cases[first]) << ": " << chi.statistic;
  }
}
