// White brushed metal, plastic and thin glass send back all light: what their facets lose is tabulated by direction,
// roughness and strength.
#include <gtest/gtest.h>

#include "glsl/furnace.hpp"

using namespace isophote;
using gpu::BsdfCase;

namespace {

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
  test::expectAllLight(cases, labels, {}, "brushed");
}

} // namespace

TEST(AnisotropicFurnace, Test20BrushedSurfacesSendBackAllLight) { expectLossless({0.2f}, {0.5f, 1.0f}, {0.0, 1.3}); }

TEST(AnisotropicFurnace, Test20BrushedSurfacesOfAllRoughnessesAndStrengthsSendBackAllLightSlow) {
  expectLossless({0.05f, 0.2f, 0.5f, 1.0f}, {0.1f, 0.3f, 0.6f, 1.0f}, {0.0, 0.4, 0.8, 1.2, 1.57});
}
