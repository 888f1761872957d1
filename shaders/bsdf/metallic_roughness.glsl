// The parameters of a surface's base: the glTF 2.0 metallic-roughness model with transmission. Formulas: docs/bsdf.md.
#ifndef ISOPHOTE_BSDF_METALLIC_ROUGHNESS_GLSL
#define ISOPHOTE_BSDF_METALLIC_ROUGHNESS_GLSL

#include "bsdf/diffuse_transmission.glsl"
#include "bsdf/fresnel.glsl"
#include "bsdf/glass_loss.glsl"
#include "bsdf/iridescence.glsl"
#include "shared/bsdf_constants.h"
#include "shared/constants.glsl"

struct MetallicRoughness {
  vec3 baseColor;
  float metallic;
  vec3 f0;     // of all facets but those of glass
  float alpha; // roughness squared, of anisotropic facets the geometric mean of both widths; below kMirrorAlpha the
               // specular lobe is a delta mirror
  vec2 width;  // alpha along x and y
  vec2 grain;  // roughness and strength of anisotropic facets
  uint anisotropicAlbedo; // where their table begins; kInvalidIndex: isotropic
  vec3 f90;
  float diffuse;      // share of the surface that has a diffuse lobe under its coat
  float ior;          // of opaque dielectric facets, where the setting fresnel is exact; below 1 stands for infinity
  uint exactAlbedo;   // where the table of their albedo begins in scene.view.facetAlbedo, as the setting has it
  float dielectricF0; // of the coat over the diffuse lobe: its largest channel, so that no channel gains energy
  float dielectricF90;
  vec3 glassF0;     // of dielectric facets at normal incidence
  float glassF90;   // and at grazing
  float glass;      // share of the surface whose facets transmit
  float eta;        // index behind the surface over the index in front; of thin walls that of the wall
  bool thinWalled;  // both boundaries in one: transmission does not bend
  uint lossInFront; // half tables of glassLoss for light from wo's side and from the other; kInvalidIndex: none
  uint lossBehind;
  Iridescence film;
  uint filmAlbedo; // where the table of the filmed dielectric begins; kInvalidIndex: none
  vec3 conductorN; // complex index of the metal; 0: it reflects its base color
  vec3 conductorK;
  DiffuseTransmission behind; // the part of the diffuse lobe on the other side
};

/// Derives the lobes' parameters from glTF's factors after texturing.
///
/// Source: Khronos, glTF 2.0 appendix B; KHR_materials_ior; KHR_materials_specular.
/// @param ior           of the dielectric; 0 stands for infinity as in KHR_materials_ior
/// @param roughness     perceptual, in [0, 1]
/// @param specularColor linear, any positive value; the reflectance is clamped to 1
MetallicRoughness metallicRoughness(const vec3 baseColor, const float metallic, const float roughness, const float ior,
                                    const float specular, const vec3 specularColor) {
  const float amplitude = (ior - 1.0) / (ior + 1.0);
  const vec3 dielectric = min(amplitude * amplitude * specularColor, vec3(1.0)) * specular;
  MetallicRoughness m;
  m.baseColor = baseColor;
  m.metallic = metallic;
  m.alpha = roughness * roughness;
  m.width = vec2(m.alpha);
  m.grain = vec2(0.0);
  m.anisotropicAlbedo = kInvalidIndex;
  m.f0 = mix(dielectric, baseColor, metallic);
  m.f90 = vec3(mix(specular, 1.0, metallic));
  m.diffuse = 1.0 - metallic;
  m.ior = ior;
  m.exactAlbedo = 0u;
  m.dielectricF0 = max(dielectric.x, max(dielectric.y, dielectric.z));
  m.dielectricF90 = specular;
  m.glassF0 = dielectric;
  m.glassF90 = specular;
  m.glass = 0.0;
  m.eta = 1.0;
  m.thinWalled = true;
  m.lossInFront = kInvalidIndex;
  m.lossBehind = kInvalidIndex;
  m.film = Iridescence(0.0, 1.0, 0.0);
  m.filmAlbedo = kInvalidIndex;
  m.conductorN = vec3(0.0);
  m.conductorK = vec3(0.0);
  m.behind = kNoDiffuseTransmission;
  return m;
}

/// Lets a part of the diffuse lobe out on the other side.
void setDiffuseTransmission(inout MetallicRoughness m, const DiffuseTransmission behind, const bool thinWalled) {
  m.behind = behind;
  m.thinWalled = thinWalled;
}

/// Names the tables that restore what rough glass loses.
///
/// @param table     of the material's index in air, kInvalidIndex: none
/// @param frontFace wo is in the air
void setGlassLoss(inout MetallicRoughness m, const uint table, const bool frontFace) {
  if (table == kInvalidIndex) return;
  m.lossInFront = frontFace ? table : table + kGlassLossHalf;
  m.lossBehind = frontFace ? table + kGlassLossHalf : table;
}

/// Names the table of the albedo that opaque dielectric facets have where the setting fresnel is exact.
/// @param ior of the material in air
void setExactAlbedo(inout MetallicRoughness m, const float ior, const uint table) {
  m.ior = ior;
  m.exactAlbedo = kFresnel == kFresnelExact ? table : 0u;
}

/// Widens the facets' slopes along x.
///
/// Source: Khronos, KHR_materials_anisotropy: mix(alpha, 1, strength^2) along x, alpha along y. The tables of glass and
/// layers are read at the geometric mean.
/// @param strength in [0, 1]
/// @param table    of the albedo
void setAnisotropy(inout MetallicRoughness m, const float strength, const uint table) {
  if (strength <= 0.0) return;
  const vec2 width = vec2(mix(m.alpha, 1.0, strength * strength), m.alpha);
  if (width.x < kNarrowestAlpha) return;
  m.grain = vec2(sqrt(m.alpha), strength);
  m.anisotropicAlbedo = table;
  m.width = max(width, vec2(kNarrowestAlpha));
  m.alpha = sqrt(m.width.x * m.width.y);
}

/// Turns a share of the dielectric into glass: facets that reflect by the exact Fresnel equations and transmit the
/// rest.
///
/// Source: Khronos, KHR_materials_transmission and KHR_materials_volume.
/// @param m            as metallicRoughness returns it
/// @param transmission share, in [0, 1]; an index that stands for infinity lets nothing through
/// @param eta          relativeIor; of thin walls the wall's own index
void setTransmission(inout MetallicRoughness m, const float transmission, const float eta, const bool thinWalled) {
  m.f0 = mix((1.0 - transmission) * m.glassF0, m.baseColor, m.metallic);
  m.f90 = vec3(mix((1.0 - transmission) * m.dielectricF90, 1.0, m.metallic));
  m.diffuse = (1.0 - m.metallic) * (1.0 - transmission);
  m.glass = (1.0 - m.metallic) * transmission;
  m.eta = eta;
  m.thinWalled = thinWalled;
}

#endif
