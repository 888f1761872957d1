#ifndef ISOPHOTE_TESTS_HOMOGENEOUS_CASE_H
#define ISOPHOTE_TESTS_HOMOGENEOUS_CASE_H

#include "shared/glsl_compat.h"

ISOPHOTE_SHARED_BEGIN

struct HomogeneousCase {
  vec3 extinction;
  float limit;
  vec3 albedo;
  vec3 beta;
  uvec2 bits;
};

struct HomogeneousResult {
  vec3 transmittance; // over `limit`
  float opticalDepth; // sampled
  vec3 weight;
  float distance;
  uint scattered;
};

ISOPHOTE_SHARED_END

#endif
