#ifndef ISOPHOTE_TESTS_SPHERE_LIGHT_CASE_H
#define ISOPHOTE_TESTS_SPHERE_LIGHT_CASE_H

#include "shared/glsl_compat.h"

ISOPHOTE_SHARED_BEGIN

struct SphereLightCase {
  vec3 center;
  float radius;
  vec3 p;
  vec2 u;
  vec3 direction; // of a ray from p, any length
};

struct SphereLightResult {
  vec3 normal; // of the sample
  vec3 wi;
  float distance;
  float pdf;
  float hitPdf; // of a ray along wi
  uint found;   // of the ray along `direction`
  float t;
  float halfChord;
};

ISOPHOTE_SHARED_END

#endif
