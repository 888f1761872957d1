// The material model of shaders/bsdf/metallic_roughness.glsl in double precision, written from docs/bsdf.md.
#pragma once

#include <glm/glm.hpp>

#include "oracle/bsdf_fresnel.hpp"

namespace isophote::oracle {

struct MetallicRoughness {
  glm::dvec3 baseColor{1};
  double metallic = 0;
  double alpha = 1;    ///< roughness squared; below gpu::kMirrorAlpha the specular lobe is a delta mirror
  glm::dvec2 width{1}; ///< alpha along x and y; then alpha is their geometric mean
  glm::dvec3 f0{0};    ///< of all facets but those of glass
  glm::dvec3 f90{0};
  double dielectricF0 = 0; ///< of the coat over the diffuse lobe, its largest channel
  double dielectricF90 = 0;
  glm::dvec3 glassF0{0};   ///< of dielectric facets at normal incidence
  double glassF90 = 0;     ///< and at grazing
  double transmission = 0; ///< share of the dielectric that is glass
  double outerIor = 1;     ///< on wo's side
  double innerIor = 1;     ///< on the other side; of thin walls that of the wall
  bool thinWalled = true;
  ThinFilm film;
  glm::dvec3 conductorN{0}; ///< of the metal; 0: it reflects its base color
  glm::dvec3 conductorK{0};
  double diffuseTransmission = 0;         ///< share of the diffuse light that crosses the surface
  glm::dvec3 diffuseTransmissionColor{1}; ///< of what crosses
  double diffuseEta = 1;                  ///< index behind over index in front, of the light that crosses diffusely
  bool multipleScattering = true;
  bool brushedAlbedo = false; ///< what anisotropic facets lose is that of their direction, not of their mean width
};

struct BsdfSample {
  glm::dvec3 wiLocal{0, 0, 1};
  glm::dvec3 weight{0};     ///< f |cos| / pdf; for delta lobes reflectance / probability of the lobe
  double pdfSolidAngle = 0; ///< of all continuous lobes; 0 for delta lobes
  bool delta = false;
  bool valid = false;
  double eta = 1; ///< index on wi's side over the index on wo's
};

[[nodiscard]] MetallicRoughness metallicRoughness(const glm::dvec3& baseColor, double metallic, double roughness,
                                                  double ior, double specular, const glm::dvec3& specularColor);

/// The same with `transmission` of the dielectric made of glass, seen from its front or its back.
[[nodiscard]] MetallicRoughness withTransmission(MetallicRoughness m, double transmission, double ior, bool frontFace,
                                                 bool thinWalled);

/// The same with a Lambert lobe on both sides: mix(diffuse_brdf, diffuse_btdf, share) below the coat, as
/// KHR_materials_diffuse_transmission has it. Where the index behind is not the one in front, only the share (rarer /
/// denser)^2 of the light from the denser side crosses, which makes both directions reciprocal.
/// @param eta index behind over index in front
[[nodiscard]] MetallicRoughness withDiffuseTransmission(MetallicRoughness m, double share, const glm::dvec3& color,
                                                        double eta);

[[nodiscard]] MetallicRoughness withAnisotropy(MetallicRoughness m, double strength);
[[nodiscard]] MetallicRoughness withConductor(MetallicRoughness m, const glm::dvec3& n, const glm::dvec3& k);
[[nodiscard]] MetallicRoughness withFilm(MetallicRoughness m, const ThinFilm& film);

/// What facets other than glass reflect. @param cosine between their normal and wo
[[nodiscard]] glm::dvec3 facetReflectance(const MetallicRoughness& m, double cosine);

/// Reflectance of a facet of glass, per channel. @param cosine between its normal and wo
[[nodiscard]] glm::dvec3 glassReflectance(const MetallicRoughness& m, double cosine);

/// Whether the transmitting lobe is only ever sampled: smooth surfaces, and refraction by nearly equal indices.
[[nodiscard]] bool transmitsDelta(const MetallicRoughness& m);

/// f |cos wi| of the continuous lobes for radiance, 0 unless wo lies above the surface; wi.z < 0 is transmission.
[[nodiscard]] glm::dvec3 evalBsdf(const MetallicRoughness& m, const glm::dvec3& woLocal, const glm::dvec3& wiLocal);

/// The part of it of the diffuse lobe and of scattering between facets of glass.
[[nodiscard]] glm::dvec3 evalDiffuse(const MetallicRoughness& m, const glm::dvec3& woLocal, const glm::dvec3& wiLocal);

/// Reflectance of scattering between the facets of the dielectric coat over the diffuse lobe.
[[nodiscard]] double coatMultipleReflectance(const MetallicRoughness& m);

/// What single reflections by the coat over the diffuse lobe reflect of light at cosine mu, by channel.
[[nodiscard]] glm::dvec3 coatReflected(const MetallicRoughness& m, double mu);

/// Its cosine-weighted mean.
[[nodiscard]] glm::dvec3 coatMeanReflected(const MetallicRoughness& m);

/// Mean share of light that passes the dielectric coat over the diffuse lobe.
[[nodiscard]] glm::dvec3 meanCoatTransmission(const MetallicRoughness& m);

/// Density of sampleBsdf's continuous lobes per steradian of wi, with their selection probabilities.
[[nodiscard]] double pdfBsdf(const MetallicRoughness& m, const glm::dvec3& woLocal, const glm::dvec3& wiLocal);

/// @param uLobe uniform in [0, 1), chooses the lobe
[[nodiscard]] BsdfSample sampleBsdf(const MetallicRoughness& m, const glm::dvec3& woLocal, double uLobe,
                                    const glm::dvec2& u);

} // namespace isophote::oracle
