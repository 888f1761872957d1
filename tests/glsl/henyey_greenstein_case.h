#ifndef ISOPHOTE_TESTS_HENYEY_GREENSTEIN_CASE_H
#define ISOPHOTE_TESTS_HENYEY_GREENSTEIN_CASE_H

#include "shared/glsl_compat.h"

ISOPHOTE_SHARED_BEGIN

struct HenyeyGreensteinCase {
  vec3 wo;
  float g;
  vec3 wi; // evaluated
  vec2 u;  // sampled
};

struct HenyeyGreensteinResult {
  float value; // at wi
  vec3 sampled;
  float sampledValue;
};

ISOPHOTE_SHARED_END

#endif
