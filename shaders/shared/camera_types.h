// The camera as the device reads it.
#ifndef ISOPHOTE_SHARED_CAMERA_TYPES_H
#define ISOPHOTE_SHARED_CAMERA_TYPES_H

#include "glsl_compat.h"

ISOPHOTE_SHARED_BEGIN

// With s in [-1,1]^2 over the image (x right, y up):
//   perspective:  origin = position,                      direction = normalize(forward + s.x right + s.y up)
//   orthographic: origin = position + s.x right + s.y up, direction = forward
// so `right` and `up` carry half the view's extent (tangents of half angles, or world units).
struct CameraRecord {
  vec3 position; // relative to the scene's world origin
  float znear;   // along forward; geometry nearer is not seen
  vec3 right;
  float zfar; // 0: unlimited
  vec3 up;
  uint orthographic;
  vec3 forward; // unit
};

// The pixel filter as inverse cumulative distribution per axis: entry i is the offset from the pixel's center, in
// pixels, at probability i / (kFilterTableSize - 1); linear in between.
ISOPHOTE_CONST uint kFilterTableSize = 1025u;

ISOPHOTE_SHARED_END

#endif
