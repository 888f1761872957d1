// The material model with the facets and the reflectance that the settings choose, against the papers.
#include <numbers>

#include <gtest/gtest.h>

#include "glsl/bsdf_material_cases.hpp"
#include "oracle/bsdf_facets.hpp"

using namespace isophote;
using gpu::BsdfCase;
using gpu::BsdfResult;

namespace {

struct Choice {
  Ndf ndf = Ndf::Ggx;
  Masking masking = Masking::Correlated;
  Fresnel fresnel = Fresnel::Gltf;
  bool multipleScattering = false;

  [[nodiscard]] std::vector<gpu::SpecConstant> constants() const {
    return {{setting_id::kNdf, static_cast<uint32_t>(ndf)},
            {setting_id::kMasking, static_cast<uint32_t>(masking)},
            {setting_id::kFresnel, static_cast<uint32_t>(fresnel)},
            {setting_id::kMultipleScattering, multipleScattering ? 1u : 0u}};
  }
};

constexpr Choice kChoices[] = {{Ndf::Beckmann, Masking::Correlated, Fresnel::Exact},
                               {Ndf::BlinnPhong, Masking::Separable, Fresnel::Schlick}};

enum class Kind { Metal, BlackPlastic, Glass };

double schlick(double normal, double cosine) { return normal + (1 - normal) * std::pow(1 - cosine, 5); }

// Of index 1.5, from outside.
double reflectance(Kind kind, Fresnel fresnel, double cosine) {
  if (kind == Kind::Metal) return 1;
  const bool exact = kind == Kind::Glass ? fresnel != Fresnel::Schlick : fresnel == Fresnel::Exact;
  return exact ? oracle::fresnelDielectric(cosine, 1.5) : schlick(0.04, cosine);
}

// f |cos wi| of single scattering: Walter et al. 2007, eq. 20 and 21, for radiance.
double expectedValue(Kind kind, const Choice& choice, const glm::dvec3& wo, const glm::dvec3& wi, double alpha) {
  const oracle::FacetKind facets{choice.ndf, choice.masking};
  const glm::dvec2 width(alpha);
  if (wi.z > 0) {
    const glm::dvec3 wm = glm::normalize(wo + wi);
    return reflectance(kind, choice.fresnel, glm::dot(wo, wm)) * oracle::facetD(choice.ndf, wm, width) *
           oracle::facetG2(facets, wo, wi, width) / (4 * wo.z);
  }
  if (kind != Kind::Glass) return 0;
  glm::dvec3 wm = glm::normalize(wo + 1.5 * wi);
  if (wm.z < 0) wm = -wm;
  const double cosineO = glm::dot(wo, wm), cosineI = -glm::dot(wi, wm);
  if (cosineO <= 0 || cosineI <= 0) return 0;
  const double length = glm::length(wo + 1.5 * wi);
  return (1 - reflectance(kind, choice.fresnel, cosineO)) * oracle::facetD(choice.ndf, wm, width) *
         oracle::facetG2(facets, wo, {wi.x, wi.y, -wi.z}, width) * cosineO * cosineI / (wo.z * length * length);
}

BsdfCase material(Kind kind, float alpha) {
  BsdfCase c = test::bsdfMaterial(glm::vec3(kind == Kind::BlackPlastic ? 0 : 1), kind == Kind::Metal ? 1.0f : 0.0f,
                                  std::sqrt(alpha));
  c.transmission = kind == Kind::Glass ? 1 : 0;
  return c;
}

double between(double low, double high, std::mt19937& generator) {
  return std::lerp(low, high, double(test::uniform(generator)));
}

} // namespace

// And test 4 of the reference list: the weight of a sample is value over density, evaluated anew.
TEST(BsdfFacets, ValuesMatchTheOracleAndWeightsTheValues) {
  for (const Choice& choice : kChoices) {
    std::mt19937 generator(3);
    std::vector<BsdfCase> cases;
    std::vector<Kind> kinds;
    for (const Kind kind : {Kind::Metal, Kind::BlackPlastic, Kind::Glass}) {
      for (int i = 0; i < 150; ++i) {
        BsdfCase c = material(kind, float(between(0.1, 1, generator)));
        c.wo = test::directionOf(between(0.05, 1, generator), 0.4);
        c.wi = test::directionOf(between(0.05, 1, generator), between(0, 6, generator));
        if (kind == Kind::Glass && i % 2 == 0) c.wi.z = -c.wi.z;
        test::drawUniforms(c, generator);
        cases.push_back(c);
        kinds.push_back(kind);
      }
    }
    const auto results = test::probeBsdf(cases, choice.constants());
    for (size_t i = 0; i < cases.size(); ++i) {
      const double alpha = double(cases[i].roughness) * double(cases[i].roughness);
      const double expected = expectedValue(kinds[i], choice, glm::dvec3(cases[i].wo), glm::dvec3(cases[i].wi), alpha);
      EXPECT_NEAR(double(results[i].fCos.y), expected, 1e-4 * expected + 1e-7)
          << "ndf " << uint32_t(choice.ndf) << " kind " << int(kinds[i]) << " " << test::describe(cases[i]);
      if ((results[i].flags & gpu::kBsdfValid) == 0) continue;
      const double density = double(results[i].pdfAtSampled), value = double(results[i].fCosSampled.y);
      EXPECT_NEAR(double(results[i].sampledPdf), density, 1e-4 * density);
      EXPECT_NEAR(double(results[i].weight.y) * density, value, 1e-4 * value);
    }
  }
}

// Test 8 of the reference list, with multiple scattering and the diffuse lobe: f(wo, wi) = f(wi, wo).
static void expectReciprocity(Choice choice) {
  choice.multipleScattering = true;
  std::mt19937 generator(5);
  std::vector<BsdfCase> cases;
  for (int i = 0; i < 300; ++i) {
    BsdfCase c = test::mixedMaterial(float(between(0.2, 1, generator)));
    c.anisotropy = i % 3 == 0 ? 0.7f : 0.0f;
    if (c.anisotropy > 0) c.roughness = 0.4f; // one table
    c.wo = test::directionOf(between(0.05, 1, generator), between(0, 6, generator));
    c.wi = test::directionOf(between(0.05, 1, generator), between(0, 6, generator));
    cases.push_back(c);
    std::swap(c.wo, c.wi);
    cases.push_back(c);
  }
  const auto results = test::probeBsdf(cases, choice.constants());
  for (size_t i = 0; i < cases.size(); i += 2) {
    const double there = double(results[i].fCos.y) / double(cases[i].wi.z);
    const double back = double(results[i + 1].fCos.y) / double(cases[i + 1].wi.z);
    EXPECT_NEAR(there, back, 1e-4 * there) << test::describe(cases[i]);
  }
}

TEST(BsdfFacets, Test8OpaqueSurfacesAreReciprocal) { expectReciprocity(kChoices[0]); }

TEST(BsdfFacets, Test8OpaqueSurfacesAreReciprocalSlow) { expectReciprocity(kChoices[1]); }
