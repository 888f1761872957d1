#ifndef ISOPHOTE_TESTS_CAMERA_RAY_CASE_H
#define ISOPHOTE_TESTS_CAMERA_RAY_CASE_H

#include "shared/camera_types.h"
#include "shared/glsl_compat.h"

ISOPHOTE_SHARED_BEGIN

struct CameraRayCase {
  CameraRecord camera;
  vec2 pixelPosition;
  vec2 imageSize;
  vec2 uLens;
};

struct CameraRayResult {
  vec3 origin;
  float tMin;
  vec3 direction;
  float tMax;
};

ISOPHOTE_SHARED_END

#endif
