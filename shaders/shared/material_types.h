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

// Texture members index the TextureSlot array, kInvalidIndex: none.
struct MaterialRecord {
  vec4 baseColor;
  vec3 emissive;
  float metallic;
  vec3 specularColor;
  float roughness;
  float specular;
  float ior;
  float alphaCutoff;
  uint alphaMode;
  uint flags;
  uint baseColorSlot;
  uint metallicRoughnessSlot;
  uint normalSlot;
  uint emissiveSlot;
  uint specularSlot;
  uint specularColorSlot;
};

ISOPHOTE_SHARED_END

#endif
