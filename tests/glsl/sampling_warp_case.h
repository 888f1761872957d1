#ifndef ISOPHOTE_TESTS_SAMPLING_WARP_CASE_H
#define ISOPHOTE_TESTS_SAMPLING_WARP_CASE_H

#include "shared/glsl_compat.h"

ISOPHOTE_SHARED_BEGIN

ISOPHOTE_CONST uint kWarpDisk = 0u;
ISOPHOTE_CONST uint kWarpCosineHemisphere = 1u;
ISOPHOTE_CONST uint kWarpSphere = 2u;
ISOPHOTE_CONST uint kWarpCone = 3u;
ISOPHOTE_CONST uint kWarpTriangle = 4u;
ISOPHOTE_CONST uint kWarpCount = 5u;

struct SamplingWarpCase {
  vec2 u;
  uint warp;
  float oneMinusCosMax; // of the cone
};

struct SamplingWarpResult {
  vec3 point;
  float pdf;
};

ISOPHOTE_SHARED_END

#endif
