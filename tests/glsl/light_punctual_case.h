#ifndef ISOPHOTE_TESTS_LIGHT_PUNCTUAL_CASE_H
#define ISOPHOTE_TESTS_LIGHT_PUNCTUAL_CASE_H

#include "shared/glsl_compat.h"
#include "shared/light_types.h"

ISOPHOTE_SHARED_BEGIN

struct LightPunctualCase {
  PunctualLightRecord light;
  vec3 p;
};

struct LightPunctualResult {
  vec3 wi;
  float distance;
  vec3 irradiance;
};

ISOPHOTE_SHARED_END

#endif
