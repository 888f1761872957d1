#ifndef ISOPHOTE_TESTS_SPHERICAL_TRIANGLE_CASE_H
#define ISOPHOTE_TESTS_SPHERICAL_TRIANGLE_CASE_H

#include "shared/glsl_compat.h"

ISOPHOTE_SHARED_BEGIN

struct SphericalTriangleCase {
  vec3 p;
  vec3 v0;
  vec3 v1;
  vec3 v2;
  vec2 u;
};

struct SphericalTriangleResult {
  float solidAngle;
  uint stable;
  vec3 barycentrics; // where stable
};

ISOPHOTE_SHARED_END

#endif
