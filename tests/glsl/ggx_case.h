#ifndef ISOPHOTE_TESTS_GGX_CASE_H
#define ISOPHOTE_TESTS_GGX_CASE_H

#include "shared/glsl_compat.h"

ISOPHOTE_SHARED_BEGIN

struct GgxCase {
  vec3 wo;
  vec3 wi;
  vec3 wm;
  vec2 alpha;
  vec2 u;
  float uSide;
};

struct GgxResult {
  float d;          // at the case's wm
  float g1;         // of wo
  float visibility; // of wo, wi
  float weight;     // G2 / G1 of wo, wi
  float pdfNormal;  // at the case's wm
  float pdfReflection;
  vec3 sampled;
  float pdfSampled;
  vec3 sampledUnseen;    // of D cos
  float projectedLength; // of wo
};

ISOPHOTE_SHARED_END

#endif
