// Camera rays.
#ifndef ISOPHOTE_CAMERA_CAMERA_GLSL
#define ISOPHOTE_CAMERA_CAMERA_GLSL

#include "shared/camera_types.h"
#include "shared/constants.glsl"
#include "shared/geometry_types.h"

struct CameraRay {
  vec3 origin;
  vec3 direction; // unit
  float tMin;     // where the ray meets the plane znear
  float tMax;     // where it meets the plane zfar; kRayInfinity without one
};

/// The ray through a point of the image.
///
/// @param pixelPosition  pixels from the image's top left corner, x right, y down; pixel centers at + 0.5
/// @param imageSize      pixels, each >= 1
CameraRay cameraRay(const CameraRecord camera, vec2 pixelPosition, vec2 imageSize) {
  const vec2 s = vec2(2.0, -2.0) * pixelPosition / imageSize + vec2(-1.0, 1.0);
  const vec3 offset = s.x * camera.right + s.y * camera.up;
  CameraRay ray;
  float cosine = 1.0; // of the ray's angle to `forward`
  if (kHasOrthographic && camera.orthographic != 0u) {
    ray.origin = camera.position + offset;
    ray.direction = camera.forward;
  } else {
    const vec3 toImage = camera.forward + offset; // at least 1 long: forward is orthogonal to offset
    cosine = inversesqrt(dot(toImage, toImage));
    ray.origin = camera.position;
    ray.direction = toImage * cosine;
  }
  ray.tMin = camera.znear / cosine;
  ray.tMax = camera.zfar > 0.0 ? camera.zfar / cosine : kRayInfinity;
  return ray;
}

#endif
