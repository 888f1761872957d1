// The white furnace: lossless materials send back all light, from any direction, at any roughness.
#include <gtest/gtest.h>

#include "glsl/bsdf_material_cases.hpp"
#include "glsl/furnace.hpp"
#include "render/setting_ids.hpp"

using namespace isophote;
using gpu::BsdfCase;
using gpu::BsdfResult;
using test::Side;

namespace {

struct Lossless {
  const char* name;
  BsdfCase (*make)(float roughness);
};

BsdfCase halfTranslucentGlass(float roughness, Side side) {
  BsdfCase c = test::glass(roughness, side);
  c.transmission = 0.4f;
  c.diffuseTransmission = 0.7f;
  c.diffuseTransmissionColor = glm::vec3(1);
  return c;
}

const Lossless kMaterials[] = {
    {"metal", [](float roughness) { return test::bsdfMaterial(glm::vec3(1), 1, roughness); }},
    {"dielectric", [](float roughness) { return test::bsdfMaterial(glm::vec3(1), 0, roughness); }},
    {"glass from outside", [](float roughness) { return test::glass(roughness, Side::Outside); }},
    {"glass from inside", [](float roughness) { return test::glass(roughness, Side::Inside); }},
    {"thin glass", [](float roughness) { return test::glass(roughness, Side::ThinWall); }},
    {"half glass",
     [](float roughness) {
       BsdfCase c = test::glass(roughness, Side::Outside);
       c.transmission = 0.5f;
       return c;
     }},
    {"diamond",
     [](float roughness) {
       BsdfCase c = test::glass(roughness, Side::Inside);
       c.ior = 2.4f;
       return c;
     }},
    {"glass of half the specular reflectance",
     [](float roughness) {
       BsdfCase c = test::glass(roughness, Side::Outside);
       c.specular = 0.5f;
       return c;
     }},
    {"paper",
     [](float roughness) {
       BsdfCase c = test::leaf(roughness, 0.7f, glm::vec3(1));
       c.baseColor = glm::vec3(1);
       return c;
     }},
    {"glass with diffuse transmission from outside",
     [](float roughness) { return halfTranslucentGlass(roughness, Side::Outside); }},
    {"glass with diffuse transmission from inside",
     [](float roughness) { return halfTranslucentGlass(roughness, Side::Inside); }},
};

// Directional albedos, off by less than 2e-3 against ten times the points.
std::vector<double> albedos(const std::vector<BsdfCase>& materials, std::span<const gpu::SpecConstant> constants = {}) {
  std::vector<double> result;
  for (const auto& weights : test::sampledWeights(materials, constants, 40000)) result.push_back(weights[1].mean());
  return result;
}

} // namespace

TEST(BsdfFurnace, Test20LosslessMaterialsSendBackAllLight) {
  std::vector<BsdfCase> cases;
  std::vector<std::string> labels;
  for (const Lossless& material : kMaterials) {
    for (const float roughness : {0.0f, 0.05f, 0.2f, 0.5f, 1.0f}) {
      for (const double cosine : {1.0, 0.5, 0.05}) {
        BsdfCase c = material.make(roughness);
        c.wo = test::directionOf(cosine, 0.3);
        cases.push_back(c);
        labels.push_back(std::string(material.name) + ", roughness " + std::to_string(roughness) + ", cosine " +
                         std::to_string(cosine));
      }
    }
  }
  const auto albedo = albedos(cases);
  for (size_t i = 0; i < cases.size(); ++i) EXPECT_NEAR(albedo[i], 1, 0.01) << labels[i];
}

namespace {

struct FacetChoice {
  const char* name;
  Ndf ndf = Ndf::Ggx;
  Masking masking = Masking::Correlated;
  Fresnel fresnel = Fresnel::Gltf;

  [[nodiscard]] std::vector<gpu::SpecConstant> constants() const {
    return {{setting_id::kNdf, static_cast<uint32_t>(ndf)},
            {setting_id::kMasking, static_cast<uint32_t>(masking)},
            {setting_id::kFresnel, static_cast<uint32_t>(fresnel)}};
  }
};

const FacetChoice kChoices[] = {
    {.name = "Beckmann", .ndf = Ndf::Beckmann},
    {.name = "Blinn-Phong", .ndf = Ndf::BlinnPhong},
    {.name = "separable", .masking = Masking::Separable},
    {.name = "exact", .fresnel = Fresnel::Exact},
    {.name = "Schlick", .fresnel = Fresnel::Schlick},
    {.name = "Beckmann, separable", .ndf = Ndf::Beckmann, .masking = Masking::Separable},
    {.name = "Blinn-Phong, separable, exact",
     .ndf = Ndf::BlinnPhong,
     .masking = Masking::Separable,
     .fresnel = Fresnel::Exact},
};

void expectLossless(const FacetChoice& choice, std::initializer_list<float> roughnesses,
                    std::initializer_list<double> cosines) {
  std::vector<BsdfCase> cases;
  std::vector<std::string> labels;
  for (const Lossless& material : kMaterials) {
    for (const float roughness : roughnesses) {
      for (const double cosine : cosines) {
        cases.push_back(material.make(roughness));
        cases.back().wo = test::directionOf(cosine, 0.3);
        labels.push_back(std::string(choice.name) + ", " + material.name + ", roughness " + std::to_string(roughness) +
                         ", cosine " + std::to_string(cosine));
      }
    }
  }
  test::expectAllLight(cases, labels, choice.constants(), choice.name);
}

} // namespace

// In the default suite: RenderFacets.Test20.
TEST(BsdfFurnace, Test20AllFacetsSendBackAllLightSlow) {
  for (const FacetChoice& choice : kChoices) {
    expectLossless(choice, {0.0f, 0.05f, 0.2f, 0.5f, 1.0f}, {1.0, 0.5, 0.05});
  }
}

TEST(BsdfFurnace, ColoredMetalsLoseTheirColorPerBounce) {
  // Kulla and Conty's series: f0 = f90 = r everywhere, so that the mean Fresnel reflectance is r and the albedo known.
  BsdfCase c = test::bsdfMaterial(glm::vec3(0.8f), 1, 1);
  c.wo = {0, 0, 1};
  const double a = 1 - std::log(2.0), kept = 0.4091; // A + B at mu = 1 and their mean, alpha = 1 (docs/bsdf.md)
  const double mean = 0.8 + 0.2 / 21;
  const double expected = 0.8 * a + mean * mean * kept / (1 - mean * (1 - kept)) * (1 - a);
  EXPECT_NEAR(albedos({c})[0], expected, 3e-3);
}

TEST(BsdfFurnace, WithoutMultipleScatteringAWhiteMetalKeepsTheTablesAlbedo) {
  BsdfCase c = test::bsdfMaterial(glm::vec3(1), 1, 1);
  c.wo = {0, 0, 1};
  const gpu::SpecConstant constants[] = {{setting_id::kMultipleScattering, 0}};
  EXPECT_NEAR(albedos({c}, constants)[0], 1 - std::log(2.0), 2e-3);
}
