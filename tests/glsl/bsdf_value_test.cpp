// Values of evalBsdf: against the oracle, reciprocity, energy, features.
#include <numbers>

#include <gtest/gtest.h>

#include "glsl/bsdf_material_cases.hpp"
#include "glsl/furnace.hpp"
#include "isophote/features.hpp"
#include "oracle/bsdf_ggx.hpp"
#include "render/setting_ids.hpp"

using namespace isophote;
using gpu::BsdfCase;
using gpu::BsdfResult;
using std::numbers::pi;

namespace {

// A random material; every fourth one a plain metal, dielectric or white.
BsdfCase randomMaterial(std::mt19937& generator) {
  // Roughness from just above the mirror's limit, alpha = 1e-3.
  const float roughness = std::lerp(0.0317f, 1.0f, test::uniform(generator));
  switch (generator() % 8) {
  case 0:
    return test::metal(roughness);
  case 1:
    return test::dielectric(roughness);
  case 2:
    return test::bsdfMaterial(glm::vec3(1), 0, roughness);
  default:
    break;
  }
  const auto color = [&generator] {
    const float r = test::uniform(generator);
    const float g = test::uniform(generator);
    return glm::vec3(r, g, test::uniform(generator));
  };
  BsdfCase c = test::bsdfMaterial(color(), test::uniform(generator), roughness);
  c.specular = test::uniform(generator);
  c.specularColor = 2.0f * color();
  c.ior = 1 + 2 * test::uniform(generator);
  return c;
}

// Half of the directions near the mirror direction of wo, so that the peak is met for small alpha.
void randomDirections(BsdfCase& c, std::mt19937& generator) {
  const bool grazing = generator() % 3 == 0;
  const double cosine =
      grazing ? std::pow(10.0, -4 * double(test::uniform(generator))) : double(test::uniform(generator)) * 0.95 + 0.05;
  c.wo = test::directionOf(cosine, 2 * pi * double(test::uniform(generator)));
  const double slope = double(c.roughness * c.roughness) * 3 * double(test::uniform(generator));
  const double phi = 2 * pi * double(test::uniform(generator));
  if (generator() % 2 == 0) {
    const glm::dvec3 wm = glm::normalize(glm::dvec3(slope * std::cos(phi), slope * std::sin(phi), 1));
    const glm::dvec3 wo(c.wo);
    c.wi = glm::vec3(2 * glm::dot(wo, wm) * wm - wo);
    if (c.wi.z > 1e-5f) return;
  }
  c.wi = test::directionOf(double(test::uniform(generator)) * 0.999 + 1e-3, phi);
}

std::vector<BsdfCase> randomCases(size_t count, uint32_t seed) {
  std::mt19937 generator(seed);
  std::vector<BsdfCase> cases(count);
  for (BsdfCase& c : cases) {
    c = randomMaterial(generator);
    randomDirections(c, generator);
  }
  return cases;
}

// Means of sampleBsdf's weight, which are directional albedos, one a material, by a rank-3 lattice of random numbers
// (Roberts 2018, "The Unreasonable Effectiveness of Quasirandom Sequences", R3). Against 4e5 points the error is below
// 1e-3.
std::vector<glm::dvec3> sampledAlbedos(const std::vector<BsdfCase>& materials,
                                       std::span<const gpu::SpecConstant> constants = {}, int count = 130000) {
  std::vector<glm::dvec3> albedos;
  for (const auto& weights : test::sampledWeights(materials, constants, count))
    albedos.emplace_back(weights[0].mean(), weights[1].mean(), weights[2].mean());
  return albedos;
}

// What the albedo table leaves of multiple scattering, (1 - E(wo)) (1 - E(wi)) cos / (pi (1 - mean E)): E is known to
// 1.5e-3, at small cosines or roughness to 1e-2, its mean to 3e-4 (docs/bsdf.md).
double multipleScatteringError(const oracle::MetallicRoughness& m, double muO, double muI) {
  const auto lost = [&](const glm::dvec2& albedo) { return std::max(1 - albedo.x - albedo.y, 0.0); };
  const double lostO = lost(oracle::directionalAlbedo(muO, m.alpha));
  const double lostI = lost(oracle::directionalAlbedo(muI, m.alpha));
  const double mean = std::max(lost(oracle::meanAlbedo(m.alpha)), 1e-6);
  const double error = std::min(muO, muI) < 0.05 || m.alpha < 0.05 ? 1e-2 : 1.5e-3;
  return (error * (lostO + lostI + error) + lostO * lostI * std::min(1.0, 3e-4 / mean)) / mean * muI / pi;
}

// Density of the specular lobe alone.
double specularDensity(const BsdfCase& c) {
  const glm::dvec3 wo(c.wo);
  const glm::dvec3 wm = glm::normalize(wo + glm::dvec3(c.wi));
  const glm::dvec2 alpha(double(c.roughness) * double(c.roughness));
  return oracle::pdfVisibleNormal(wo, wm, alpha) / (4 * glm::dot(wo, wm));
}

} // namespace

// Tolerance: single precision leaves 1e-4 of the specular peak at alpha = 1e-3 (the half vector's tilt is known to 6e-8
// of 1, divided by alpha); the albedo table leaves 2e-3 of the diffuse lobe, 1.5e-2 where a cosine is below 0.05
// (docs/bsdf.md), and the same of the lobes' probabilities.
TEST(Bsdf, ValuesAndDensitiesMatchTheOracle) {
  const auto cases = randomCases(20000, 3);
  const auto results = test::probeBsdf(cases);
  for (size_t i = 0; i < cases.size(); ++i) {
    const BsdfCase& c = cases[i];
    const oracle::MetallicRoughness m = test::oracleMaterial(c);
    const glm::dvec3 wo(c.wo);
    const glm::dvec3 wi(c.wi);
    const glm::dvec3 expected = oracle::evalBsdf(m, wo, wi);
    const double table = std::min(wo.z, wi.z) < 0.05 ? 1.5e-2 : 2e-3;
    // The inputs' lengths are rounded to 1e-7, which the half vector magnifies where wo and wi are nearly opposite.
    const double single = 2e-4 + 1e-6 / glm::length(wo + wi);
    for (int k = 0; k < 3; ++k) {
      const double tolerance = single * expected[k] + table * m.baseColor[k] * (1 - m.metallic) * wi.z / pi +
                               multipleScatteringError(m, wo.z, wi.z) + 1e-12;
      EXPECT_NEAR(double(results[i].fCos[k]), expected[k], tolerance) << test::describe(c);
    }
    const double density = oracle::pdfBsdf(m, wo, wi);
    const double probability = wo.z < 0.05 ? 1.5e-2 : 2e-3;
    const double tolerance = single * density + probability * (specularDensity(c) + wi.z / pi);
    EXPECT_NEAR(double(results[i].pdf), density, tolerance) << test::describe(c);
  }
}

TEST(Bsdf, IsReciprocal) {
  auto cases = randomCases(10000, 4);
  const auto forward = test::probeBsdf(cases);
  for (BsdfCase& c : cases) std::swap(c.wo, c.wi);
  const auto backward = test::probeBsdf(cases);
  for (size_t i = 0; i < cases.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const double there = double(forward[i].fCos[k]) / double(cases[i].wo.z); // swapped: wo is the former wi
      const double back = double(backward[i].fCos[k]) / double(cases[i].wi.z);
      EXPECT_NEAR(there, back, 1e-4 * there) << test::describe(cases[i]);
    }
  }
}

TEST(Bsdf, IsBlackUnlessBothDirectionsLieAboveTheSurface) {
  BsdfCase below = test::mixedMaterial(0.5f);
  below.wo = test::directionOf(-0.2, 1);
  BsdfCase inward = test::mixedMaterial(0.5f);
  inward.wi = test::directionOf(-0.2, 1);
  for (const BsdfResult& result : test::probeBsdf({below, inward})) {
    EXPECT_EQ(result.fCos, glm::vec3(0));
    EXPECT_EQ(result.pdf, 0);
  }
  EXPECT_EQ(test::probeBsdf({below})[0].flags & gpu::kBsdfValid, 0u);
}

TEST(Bsdf, NeverReflectsMoreThanArrives) {
  std::vector<BsdfCase> materials;
  for (const float roughness : {0.0f, 0.2f, 0.5f, 1.0f}) {
    for (const float metallic : {0.0f, 0.5f, 1.0f}) {
      for (const float ior : {1.5f, 0.0f}) { // 0: reflects everything
        for (const double cosine : {1.0, 0.3, 0.05}) {
          materials.push_back(test::bsdfMaterial(glm::vec3(1), metallic, roughness));
          materials.back().ior = ior;
          materials.back().wo = test::directionOf(cosine, 0.2);
        }
      }
    }
  }
  // The lattice is off by up to 2e-3 where few samples weigh much; what exceeds 1 with it is measured anew.
  std::vector<BsdfCase> again;
  const auto albedos = sampledAlbedos(materials);
  for (size_t i = 0; i < materials.size(); ++i) {
    if (albedos[i].y > 1 + 1e-3) again.push_back(materials[i]);
  }
  ASSERT_LT(again.size(), 8u);
  const auto better = sampledAlbedos(again, {}, 3'000'000);
  for (size_t i = 0; i < again.size(); ++i)
    EXPECT_LT(better[i].y, 1 + 1e-3) << test::describe(again[i]) << " ior " << again[i].ior;
}

// What a white dielectric's coat reflects, its base loses: together 1, within the albedo table's accuracy.
TEST(Bsdf, WhiteDielectricReflectsEverything) {
  std::vector<BsdfCase> materials;
  for (const float alpha : {0.0f, 1e-3f, 0.01f, 0.1f, 0.5f, 1.0f}) {
    for (const double cosine : {1.0, 0.7, 0.3, 0.1, 0.05}) {
      materials.push_back(test::bsdfMaterial(glm::vec3(1), 0, std::sqrt(alpha)));
      materials.back().wo = test::directionOf(cosine, 0.2);
    }
  }
  const auto albedos = sampledAlbedos(materials);
  for (size_t i = 0; i < materials.size(); ++i) {
    EXPECT_NEAR(albedos[i].y, 1, 1.5e-3) << test::describe(materials[i]);
  }
}

TEST(Bsdf, MetalReflectsTheTabulatedAlbedoOnce) {
  std::vector<BsdfCase> materials;
  for (const float alpha : {0.01f, 0.1f, 0.5f, 1.0f}) {
    for (const double cosine : {1.0, 0.5, 0.1}) {
      materials.push_back(test::bsdfMaterial({1, 0.5f, 0.04f}, 1, std::sqrt(alpha)));
      materials.back().wo = test::directionOf(cosine, 0.2);
    }
  }
  const gpu::SpecConstant singleScattering[] = {{setting_id::kMultipleScattering, 0}};
  const auto albedos = sampledAlbedos(materials, singleScattering);
  for (size_t i = 0; i < materials.size(); ++i) {
    const BsdfCase& c = materials[i];
    const glm::dvec2 ab = oracle::quadratureAlbedo(double(c.wo.z), double(c.roughness) * double(c.roughness), 200);
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(albedos[i][k], double(c.baseColor[k]) * ab.x + ab.y, 1e-3) << test::describe(c);
    }
  }
}

TEST(Bsdf, WithoutSpecularItIsLambertAndReadsNoTable) {
  const gpu::SpecConstant constants[] = {{static_cast<uint32_t>(Feature::kHasSpecular), 0},
                                         {static_cast<uint32_t>(Feature::kHasMirror), 0}};
  BsdfCase c = test::bsdfMaterial({0.2f, 0.5f, 0.9f}, 0, 0.5f);
  c.specular = 0;
  std::mt19937 generator(1);
  std::vector<BsdfCase> cases(1000, c);
  for (BsdfCase& each : cases) {
    test::drawUniforms(each, generator);
    randomDirections(each, generator);
  }
  const auto& kernel = test_glsl_kernels::kernelSource("bsdf_probe");
  const auto lambert = test::runProbe<BsdfCase, BsdfResult>(kernel, cases, 0, constants); // no scene at all
  const auto full = test::probeBsdf(cases);
  for (size_t i = 0; i < cases.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const double expected = double(c.baseColor[k]) * double(cases[i].wi.z) / pi;
      EXPECT_NEAR(double(lambert[i].fCos[k]), expected, 1e-6 * expected);
      EXPECT_NEAR(double(lambert[i].weight[k]), double(c.baseColor[k]), 1e-6);
    }
    EXPECT_EQ(lambert[i].fCos, full[i].fCos);
    EXPECT_EQ(lambert[i].pdf, full[i].pdf);
    EXPECT_EQ(lambert[i].sampledWi, full[i].sampledWi);
    EXPECT_EQ(lambert[i].weight, full[i].weight);
  }
}
