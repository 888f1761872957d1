// Materials and texture uses as the device reads them.
#ifndef ISOPHOTE_SHARED_MATERIAL_TYPES_H
#define ISOPHOTE_SHARED_MATERIAL_TYPES_H

#include "glsl_compat.h"

ISOPHOTE_SHARED_BEGIN

// A texture read by a material: uv' = (dot(uRow, (u,v,1)), dot(vRow, (u,v,1))).
struct TextureSlot {
  uint texture; // index into the texture array
  uint uvSet;
  float scale;
  vec3 uRow;
  vec3 vRow;
};

ISOPHOTE_CONST uint kAlphaOpaque = 0u;
ISOPHOTE_CONST uint kAlphaMask = 1u;
ISOPHOTE_CONST uint kAlphaBlend = 2u;
ISOPHOTE_CONST uint kMaterialDoubleSided = 1u;
ISOPHOTE_CONST uint kMaterialUnlit = 2u;
ISOPHOTE_CONST uint kMaterialVolume = 4u; // the boundary of a medium: thickness > 0, and something passes
ISOPHOTE_CONST uint kMaterialClear = 8u;  // a boundary that does nothing but refract: invisible between equal indices
ISOPHOTE_CONST uint kMaterialConductor = 16u;

// Texture members (…Slot) index the TextureSlot array, kInvalidIndex: none. Members are read one by one: those of a
// feature that the scene lacks cost memory only.
struct MaterialRecord {
  vec4 baseColor;
  vec3 emissive;
  float metallic;
  vec3 specularColor;
  float roughness;
  float specular;
  float ior;
  float dispersion;
  float alphaCutoff;
  uint alphaMode;
  uint flags;
  float clearcoat;
  float clearcoatRoughness;
  vec3 sheenColor;
  float sheenRoughness;
  float anisotropyStrength;
  float anisotropyRotation;
  float iridescence;
  float iridescenceIor;
  float iridescenceThicknessMinimum; // nm
  float iridescenceThicknessMaximum;
  vec3 conductorN; // complex index of refraction of the metal, where kMaterialConductor is set
  vec3 conductorK;
  float transmission;
  float diffuseTransmission;
  vec3 diffuseTransmissionColor;
  float thickness;        // 0: thin-walled
  uint glassLoss;         // where its table begins, kInvalidIndex: none
  uint exactAlbedo;       // where the table of its exact reflectance begins, in a render that asks for it
  uint anisotropicAlbedo; // where the table of its anisotropic facets begins, kInvalidIndex: none
  uint filmAlbedo;        // where the table of its filmed dielectric begins, kInvalidIndex: none
  vec3 extinction;        // of the medium behind the surface, per unit of length: absorption and scattering
  float mediumPriority;   // where media overlap, the highest fills the place
  vec3 scatteringAlbedo;  // of one scattering, scattering over extinction
  float scatterAnisotropy;
  uint baseColorSlot;
  uint metallicRoughnessSlot;
  uint normalSlot;
  uint emissiveSlot;
  uint specularSlot;
  uint specularColorSlot;
  uint clearcoatSlot;
  uint clearcoatRoughnessSlot;
  uint clearcoatNormalSlot;
  uint sheenColorSlot;
  uint sheenRoughnessSlot;
  uint anisotropySlot;
  uint iridescenceSlot;
  uint iridescenceThicknessSlot;
  uint transmissionSlot;
  uint diffuseTransmissionSlot;
  uint diffuseTransmissionColorSlot;
  uint thicknessSlot;
};

ISOPHOTE_SHARED_END

#endif
