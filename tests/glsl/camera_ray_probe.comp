#version 460
#extension GL_GOOGLE_include_directive : require
#include "camera/camera.glsl"
#include "glsl/camera_ray_case.h"
#define PROBE_INPUT CameraRayCase
#define PROBE_OUTPUT CameraRayResult
#include "support/probe_main.glsl"

CameraRayResult probe(const CameraRayCase c) {
  const CameraRay ray = cameraRay(c.camera, c.pixelPosition, c.imageSize, c.uLens);
  return CameraRayResult(ray.origin, ray.tMin, ray.direction, ray.tMax);
}
