// The camera as the device reads it.
#ifndef ISOPHOTE_SHARED_CAMERA_TYPES_H
#define ISOPHOTE_SHARED_CAMERA_TYPES_H

#include "glsl_compat.h"

ISOPHOTE_SHARED_BEGIN

ISOPHOTE_CONST uint kCameraPerspective = 0u;
ISOPHOTE_CONST uint kCameraOrthographic = 1u;
ISOPHOTE_CONST uint kCameraPanorama = 2u;

// With s in [-1,1]^2 over the image (x right, y up):
//   perspective:  origin = position,                      direction = normalize(forward + s.x right + s.y up)
//   orthographic: origin = position + s.x right + s.y up, direction = forward
// so `right` and `up` carry half the view's extent (tangents of half angles, or world units).
//   panorama:     origin = position, direction at longitude pi s.x from forward to right, latitude pi/2 s.y; `right`
//   and
//                 `up` are unit
// A thin lens moves the origin to a point of the aperture, lensRight and lensUp being its axes times its radius, and
// turns the direction so that rays of one s meet in the plane at focusDistance along forward.
struct CameraRecord {
  vec3 position; // relative to the scene's world origin
  float znear;   // along forward, of a panorama along the ray; geometry nearer is not seen
  vec3 right;
  float zfar; // 0: unlimited
  vec3 up;
  uint kind;
  vec3 forward;        // unit
  float focusDistance; // 0: no lens
  vec3 lensRight;
  uint bladeCount; // 0: a round aperture
  vec3 lensUp;
};

// The pixel filter as inverse cumulative distribution per axis: entry i is the offset from the pixel's center, in
// pixels, at probability i / (kFilterTableSize - 1); linear in between.
ISOPHOTE_CONST uint kFilterTableSize = 1025u;

ISOPHOTE_SHARED_END

#endif
