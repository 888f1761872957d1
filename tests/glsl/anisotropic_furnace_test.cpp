// White brushed metal, plastic and thin glass send back all light: what their facets lose is tabulated by direction,
// roughness and strength.
#include <gtest/gtest.h>

#include "glsl/bsdf_material_cases.hpp"

using namespace isophote;
using gpu::BsdfCase;

namespace {

// Mean weight of `count` points of a rank-3 lattice (Roberts 2018).
std::vector<double> albedos(const std::vector<BsdfCase>& materials, int count) {
  const glm::dvec3 step(0.8191725133961645, 0.6710436067037893, 0.5497004779019703);
  std::vector<BsdfCase> cases;
  for (const BsdfCase& material : materials) {
    for (int i = 1; i <= count; ++i) {
      const glm::vec3 u(glm::fract(step * double(i)) * (1 - 1e-7));
      cases.push_back(material);
      cases.back().uLobe = u.x;
      cases.back().u = {u.y, u.z};
    }
  }
  const auto results = test::probeBsdf(std::move(cases));
  std::vector<double> sums(materials.size());
  for (size_t i = 0; i < results.size(); ++i) {
    if ((results[i].flags & gpu::kBsdfValid) == 0) continue;
    sums[i / size_t(count)] += double(results[i].weight.y) / count;
  }
  return sums;
}

void expectLossless(std::initializer_list<float> roughnesses, std::initializer_list<float> strengths,
                    std::initializer_list<double> azimuths) {
  std::vector<BsdfCase> cases;
  std::vector<std::string> labels;
  for (const char* name : {"metal", "plastic", "thin glass"}) {
    for (const float roughness : roughnesses) {
      for (const float strength : strengths) {
        for (const double cosine : {1.0, 0.05}) {
          for (const double azimuth : azimuths) {
            BsdfCase c = test::bsdfMaterial(glm::vec3(1), name == std::string("metal") ? 1.0f : 0.0f, roughness);
            if (name == std::string("thin glass")) {
              c.transmission = 1;
              c.thinWalled = 1;
            }
            c.anisotropy = strength;
            c.wo = test::directionOf(cosine, azimuth);
            cases.push_back(c);
            labels.push_back(std::string(name) + ", roughness " + std::to_string(roughness) + ", strength " +
                             std::to_string(strength) + ", cosine " + std::to_string(cosine) + ", azimuth " +
                             std::to_string(azimuth));
          }
        }
      }
    }
  }
  const auto albedo = albedos(cases, 6000);
  double worst = 0;
  for (size_t i = 0; i < cases.size(); ++i) {
    EXPECT_NEAR(albedo[i], 1, 0.01) << labels[i];
    worst = std::max(worst, std::abs(albedo[i] - 1));
  }
  testing::Test::RecordProperty("worst", std::to_string(worst));
}

} // namespace

TEST(AnisotropicFurnace, Test20BrushedSurfacesSendBackAllLight) { expectLossless({0.2f}, {0.5f, 1.0f}, {0.0, 1.3}); }

TEST(AnisotropicFurnace, Test20BrushedSurfacesOfAllRoughnessesAndStrengthsSendBackAllLightSlow) {
  expectLossless({0.05f, 0.2f, 0.5f, 1.0f}, {0.1f, 0.3f, 0.6f, 1.0f}, {0.0, 0.4, 0.8, 1.2, 1.57});
}
