// Camera rays.
#ifndef ISOPHOTE_CAMERA_CAMERA_GLSL
#define ISOPHOTE_CAMERA_CAMERA_GLSL

#include "camera/aperture.glsl"
#include "math/trigonometry.glsl"
#include "shared/camera_types.h"
#include "shared/constants.glsl"
#include "shared/geometry_types.h"

struct CameraRay {
  vec3 origin;
  vec3 direction; // unit
  float tMin;     // where the ray meets the plane znear; of a panorama znear itself
  float tMax;     // the same of zfar; kRayInfinity without one
};

/// The direction of a panorama at s; beyond the borders it goes on around, over the poles too.
vec3 panoramaDirection(const CameraRecord camera, vec2 s) {
  const vec2 longitude = sinCosPi(s.x);
  const vec2 latitude = sinCosPi(0.5 * s.y);
  return latitude.y * (longitude.x * camera.right + longitude.y * camera.forward) + latitude.x * camera.up;
}

// Moves the ray to a point of the lens, without changing where it meets the plane in focus.
// @param cosine  of the ray's angle to `forward`; set anew
void throughLens(const CameraRecord camera, vec2 uLens, inout CameraRay ray, inout float cosine) {
  const vec2 lens = sampleAperture(camera.bladeCount, uLens);
  const vec3 offset = lens.x * camera.lensRight + lens.y * camera.lensUp;
  ray.origin += offset;
  ray.direction = normalize(ray.direction * (camera.focusDistance / cosine) - offset);
  cosine = dot(ray.direction, camera.forward);
}

/// The ray through a point of the image.
///
/// @param pixelPosition  pixels from the image's top left corner, x right, y down; pixel centers at + 0.5
/// @param imageSize      pixels, each >= 1
/// @param uLens          in [0, 1)^2: where on the lens, if there is one
CameraRay cameraRay(const CameraRecord camera, vec2 pixelPosition, vec2 imageSize, vec2 uLens) {
  const vec2 s = vec2(2.0, -2.0) * pixelPosition / imageSize + vec2(-1.0, 1.0);
  const vec3 offset = s.x * camera.right + s.y * camera.up;
  CameraRay ray;
  float cosine = 1.0; // of the ray's angle to `forward`
  if (kHasPanorama && camera.kind == kCameraPanorama) {
    ray.origin = camera.position;
    ray.direction = panoramaDirection(camera, s);
  } else if (kHasOrthographic && camera.kind == kCameraOrthographic) {
    ray.origin = camera.position + offset;
    ray.direction = camera.forward;
  } else {
    const vec3 toImage = camera.forward + offset; // at least 1 long: forward is orthogonal to offset
    cosine = inversesqrt(dot(toImage, toImage));
    ray.origin = camera.position;
    ray.direction = toImage * cosine;
  }
  if (kHasThinLens && camera.focusDistance > 0.0) throughLens(camera, uLens, ray, cosine);
  ray.tMin = camera.znear / cosine;
  ray.tMax = camera.zfar > 0.0 ? camera.zfar / cosine : kRayInfinity;
  return ray;
}

#endif
