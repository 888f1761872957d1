// Surfaces of a scene, as hit or light sampling asks for them.
#ifndef ISOPHOTE_TEST_SURFACE_CASE_H
#define ISOPHOTE_TEST_SURFACE_CASE_H

#include "shared/glsl_compat.h"

ISOPHOTE_SHARED_BEGIN

struct SurfaceCase {
  uint instance;
  uint triangle;
  vec2 barycentrics;
  vec3 wo;
};

struct SurfaceResult {
  vec3 p;
  vec3 pError;
  vec3 ng; // of the front
  vec3 ns;
  vec4 tangent;
  uint material;
  uint geometry;
  uint primitiveIndex;
  uint mesh;
  uint flags;
  float area;
  vec3 ngSeen; // of wo's side
  vec3 nsSeen;
  uint frontFace;
  vec4 color;
  vec2 uv0;
  vec2 uv1;
};

ISOPHOTE_SHARED_END

#endif
