// Materials, directions and random numbers that the BSDF tests share.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "glsl/bsdf_case.h"
#include "glsl/bsdf_scene.hpp"
#include "oracle/bsdf_metallic_roughness.hpp"
#include "shared/bsdf_constants.h"
#include "shared/geometry_types.h"
#include "support/probe.hpp"
#include "test_glsl_kernels.hpp"

namespace isophote::test {

inline gpu::BsdfCase bsdfMaterial(glm::vec3 baseColor, float metallic, float roughness) {
  return {.baseColor = baseColor,
          .metallic = metallic,
          .specularColor = glm::vec3(1),
          .roughness = roughness,
          .ior = 1.5f,
          .specular = 1,
          .wo = {0, 0, 1},
          .wi = {0, 0, 1},
          .uLobe = 0.5f,
          .u = {0.5f, 0.5f}};
}

inline gpu::BsdfCase metal(float roughness) { return bsdfMaterial({0.9f, 0.6f, 0.3f}, 1, roughness); }
inline gpu::BsdfCase dielectric(float roughness) { return bsdfMaterial({0.3f, 0.7f, 0.5f}, 0, roughness); }

inline gpu::BsdfCase mixedMaterial(float roughness) {
  gpu::BsdfCase c = bsdfMaterial({0.8f, 0.2f, 0.4f}, 0.4f, roughness);
  c.specularColor = {1, 0.5f, 2};
  c.specular = 0.8f;
  c.ior = 1.8f;
  return c;
}

enum class Side { Outside, Inside, ThinWall };

inline gpu::BsdfCase glass(float roughness, Side side, glm::vec3 baseColor = glm::vec3(1)) {
  gpu::BsdfCase c = bsdfMaterial(baseColor, 0, roughness);
  c.transmission = 1;
  c.backFace = side == Side::Inside ? 1 : 0;
  c.thinWalled = side == Side::ThinWall ? 1 : 0;
  return c;
}

/// Paper: light leaves on both sides of the diffuse lobe.
inline gpu::BsdfCase leaf(float roughness, float share, glm::vec3 color = {0.2f, 0.8f, 0.4f}) {
  gpu::BsdfCase c = bsdfMaterial({0.7f, 0.5f, 0.3f}, 0, roughness);
  c.thinWalled = 1;
  c.diffuseTransmission = share;
  c.diffuseTransmissionColor = color;
  return c;
}

inline glm::vec3 directionOf(double cosine, double phi) {
  const double sine = std::sqrt(1 - cosine * cosine);
  return {float(sine * std::cos(phi)), float(sine * std::sin(phi)), float(cosine)};
}

// A multiple of 2^-24 in [0, 1), as kernels draw them.
inline float uniform(std::mt19937& generator) { return float(generator() >> 8) * std::ldexp(1.0f, -24); }

inline void drawUniforms(gpu::BsdfCase& c, std::mt19937& generator) {
  c.uLobe = uniform(generator);
  c.u.x = uniform(generator);
  c.u.y = uniform(generator);
}

inline oracle::MetallicRoughness oracleMaterial(const gpu::BsdfCase& c) {
  const auto opaque = oracle::metallicRoughness(glm::dvec3(c.baseColor), double(c.metallic), double(c.roughness),
                                                double(c.ior), double(c.specular), glm::dvec3(c.specularColor));
  const auto coated = c.transmission == 0 ? opaque
                                          : oracle::withTransmission(opaque, double(c.transmission), double(c.ior),
                                                                     c.backFace == 0, c.thinWalled != 0);
  if (c.diffuseTransmission == 0) return coated;
  const bool refracts = c.transmission > 0 && c.thinWalled == 0;
  return oracle::withDiffuseTransmission(coated, double(c.diffuseTransmission), glm::dvec3(c.diffuseTransmissionColor),
                                         refracts ? coated.innerIor / coated.outerIor : 1);
}

inline std::string describe(const gpu::BsdfCase& c) {
  return "metallic " + std::to_string(c.metallic) + " alpha " + std::to_string(c.roughness * c.roughness) +
         " cosines " + std::to_string(c.wo.z) + ", " + std::to_string(c.wi.z);
}

inline std::vector<gpu::BsdfResult> probeBsdf(std::vector<gpu::BsdfCase> cases,
                                              std::span<const gpu::SpecConstant> constants = {}) {
  const auto isRoughGlass = [](const gpu::BsdfCase& c) {
    return c.transmission > 0 && c.thinWalled == 0 && c.roughness * c.roughness >= gpu::kMirrorAlpha;
  };
  std::vector<float> iors;
  for (const gpu::BsdfCase& c : cases) {
    if (isRoughGlass(c) && std::find(iors.begin(), iors.end(), c.ior) == iors.end()) iors.push_back(c.ior);
  }
  const BsdfScene scene(iors);
  for (gpu::BsdfCase& c : cases) c.glassLoss = isRoughGlass(c) ? scene.glassLoss(c.ior) : gpu::kInvalidIndex;
  return runProbe<gpu::BsdfCase, gpu::BsdfResult>(test_glsl_kernels::kernelSource("bsdf_probe"), cases, scene.address(),
                                                  constants);
}

} // namespace isophote::test
