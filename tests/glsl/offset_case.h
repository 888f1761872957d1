// Origins of rays that leave a surface.
#ifndef ISOPHOTE_TEST_OFFSET_CASE_H
#define ISOPHOTE_TEST_OFFSET_CASE_H

#include "shared/glsl_compat.h"

ISOPHOTE_SHARED_BEGIN

struct OffsetCase {
  vec3 p;
  vec3 pError;
  vec3 ng;
  vec3 w;
};

struct OffsetResult {
  vec3 origin;
};

// A ray leaves a triangle of a placed mesh at a point given by its weights.
struct LeaveCase {
  vec3 v0;
  vec3 v1;
  vec3 v2;
  vec2 barycentrics;
  vec3 direction; // world
  vec3 neighbor;  // from the triangle to another one parallel to it, in object space
  vec4 worldFromObject[3];
  vec4 objectFromWorld[3];
};

struct LeaveResult {
  vec3 pObject;
  vec3 pErrorObject;
  vec3 p; // world
  vec3 pError;
  vec3 originObject; // of the ray that leaves on the side of `direction`
  uint found;        // the triangle is met again
  uint neighborFound;
};

ISOPHOTE_SHARED_END

#endif
