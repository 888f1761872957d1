#ifndef ISOPHOTE_TESTS_MATERIAL_CASE_H
#define ISOPHOTE_TESTS_MATERIAL_CASE_H

#include "shared/glsl_compat.h"

ISOPHOTE_SHARED_BEGIN

struct MaterialCase {
  uint material;
  vec2 barycentrics;
  vec3 ng;
  vec3 ns;
  vec4 tangent;
  vec3 wo;
  uint frontFace;
};

struct MaterialResult {
  vec3 baseColor;
  uint unlit;
  vec3 reflectance;
  float metallic;
  vec3 f0;
  float alpha;
  vec3 f90;
  float dielectricF0;
  float dielectricF90;
  vec3 ns;
  vec3 coatNormal;
  vec2 coat;  // amount, roughness
  vec4 sheen; // color, roughness
  vec4 film;  // amount, index, thickness
  float glass;
  vec4 diffuseTransmission; // color, share
};

ISOPHOTE_SHARED_END

#endif
