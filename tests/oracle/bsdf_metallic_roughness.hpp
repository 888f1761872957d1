// The material model of shaders/bsdf/metallic_roughness.glsl in double precision, written from docs/bsdf.md.
#pragma once

#include <glm/glm.hpp>

namespace isophote::oracle {

struct MetallicRoughness {
  glm::dvec3 baseColor{1};
  double metallic = 0;
  double alpha = 1; ///< roughness squared; below gpu::kMirrorAlpha the specular lobe is a delta mirror
  glm::dvec3 f0{0};
  glm::dvec3 f90{0};
  double dielectricF0 = 0; ///< of the coat over the diffuse lobe, its largest channel
  double dielectricF90 = 0;
};

struct BsdfSample {
  glm::dvec3 wiLocal{0, 0, 1};
  glm::dvec3 weight{0};     ///< f |cos| / pdf; for delta lobes reflectance / probability of the lobe
  double pdfSolidAngle = 0; ///< of all continuous lobes; 0 for delta lobes
  bool delta = false;
  bool valid = false;
};

[[nodiscard]] MetallicRoughness metallicRoughness(const glm::dvec3& baseColor, double metallic, double roughness,
                                                  double ior, double specular, const glm::dvec3& specularColor);

/// f |cos wi| of the continuous lobes, 0 unless both directions lie above the surface.
[[nodiscard]] glm::dvec3 evalBsdf(const MetallicRoughness& m, const glm::dvec3& woLocal, const glm::dvec3& wiLocal);

/// The part of it that the diffuse lobe scatters.
[[nodiscard]] glm::dvec3 evalDiffuse(const MetallicRoughness& m, const glm::dvec3& woLocal, const glm::dvec3& wiLocal);

/// Density of sampleBsdf's continuous lobes per steradian of wi, with their selection probabilities.
[[nodiscard]] double pdfBsdf(const MetallicRoughness& m, const glm::dvec3& woLocal, const glm::dvec3& wiLocal);

/// @param uLobe uniform in [0, 1), chooses the lobe
[[nodiscard]] BsdfSample sampleBsdf(const MetallicRoughness& m, const glm::dvec3& woLocal, double uLobe,
                                    const glm::dvec2& u);

} // namespace isophote::oracle
