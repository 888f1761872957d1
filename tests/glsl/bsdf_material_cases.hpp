// Materials, directions and random numbers that the BSDF tests share.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "glsl/bsdf_case.h"
#include "glsl/bsdf_scene.hpp"
#include "glsl/directions.hpp"
#include "oracle/bsdf_metallic_roughness.hpp"
#include "render/setting_ids.hpp"
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

/// Where `value` is in the list, appended if it is new.
template <class T> uint32_t placeOf(std::vector<T>& list, const T& value) {
  const auto found = std::find(list.begin(), list.end(), value);
  if (found != list.end()) return static_cast<uint32_t>(found - list.begin());
  list.push_back(value);
  return static_cast<uint32_t>(list.size() - 1);
}

/// Names the tables of the cases, and returns what they are to hold.
inline TableNeeds nameTables(std::vector<gpu::BsdfCase>& cases) {
  TableNeeds needs{.facets = true};
  std::vector<float> glass;
  for (gpu::BsdfCase& c : cases) {
    const bool rough = c.roughness * c.roughness >= gpu::kMirrorAlpha;
    c.exactAlbedo = (placeOf(needs.opaqueIors, c.ior) + 1) * gpu::kFacetAlbedoSize;
    c.glassLoss = gpu::kInvalidIndex;
    if (c.transmission > 0 && c.thinWalled == 0 && rough) c.glassLoss = placeOf(glass, c.ior) * 2 * gpu::kGlassLossHalf;
    if (c.anisotropy > 0) {
      const AnisotropicSurface surface{glm::vec2(c.roughness), glm::vec2(c.anisotropy)};
      c.anisotropicAlbedo = placeOf(needs.anisotropic, surface) * anisotropicAlbedoSize(surface);
    }
  }
  for (const float ior : glass) needs.glass.push_back({.ior = ior});
  return needs;
}

inline std::vector<gpu::BsdfResult> probeBsdf(std::vector<gpu::BsdfCase> cases,
                                              std::span<const gpu::SpecConstant> constants = {}) {
  EstimatorSettings settings;
  for (const gpu::SpecConstant& constant : constants) {
    if (constant.id == setting_id::kNdf) settings.ndf = static_cast<Ndf>(constant.value);
    if (constant.id == setting_id::kMasking) settings.masking = static_cast<Masking>(constant.value);
    if (constant.id == setting_id::kFresnel) settings.fresnel = static_cast<Fresnel>(constant.value);
  }
  const TableNeeds needs = nameTables(cases);
  const BsdfScene scene(needs, settings);
  return runProbe<gpu::BsdfCase, gpu::BsdfResult>(test_glsl_kernels::kernelSource("bsdf_probe"), cases, scene.address(),
                                                  constants);
}

} // namespace isophote::test
