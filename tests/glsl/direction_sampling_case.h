#ifndef ISOPHOTE_TESTS_DIRECTION_SAMPLING_CASE_H
#define ISOPHOTE_TESTS_DIRECTION_SAMPLING_CASE_H

#include "shared/glsl_compat.h"

ISOPHOTE_SHARED_BEGIN

struct DirectionCase {
  vec3 baseColor;
  float metallic;
  float roughness;
  float glass; // share of the dielectric that transmits, solid, of index 1.5
  vec3 wo;
  vec3 wi;
  float uLobe;
  vec2 u;
};

ISOPHOTE_CONST uint kDirectionDelta = 1u;
ISOPHOTE_CONST uint kDirectionValid = 2u;

struct DirectionResult {
  vec3 fCos; // of the BSDF at the case's wi
  float pdfLobes;
  float pdf;
  vec3 sampledWi;
  vec3 weight;
  float sampledPdf;
  vec3 fCosSampled; // evaluated anew at sampledWi
  float pdfAtSampled;
  uint flags;
};

ISOPHOTE_SHARED_END

#endif
