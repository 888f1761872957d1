#version 460
#extension GL_GOOGLE_include_directive : require

#include "geometry/surface.glsl"
#include "geometry/traverse.glsl"
#include "glsl/traversal_case.h"
#define PROBE_INPUT TraversalCase
#define PROBE_OUTPUT StepResult
#include "support/probe_main.glsl"

StepResult probe(const TraversalCase c) {
  SceneRef scene = SceneRef(pc.extra);
  const AlphaKey key = AlphaKey(c.pixel, c.sampleIndex, uvec2(1u, 2u), c.vertex);
  StepResult result = StepResult(kInvalidIndex, kInvalidIndex, kInvalidIndex, 0.0, 0.0);
  const RayHit hit = traceClosest(scene, c.origin, c.direction, c.tMin, c.tMax, key, kInvalidIndex);
  if (!hit.found) return result;
  BvhTriangleRef triangles = BvhTriangleRef(scene.view.triangles);
  result.first = triangles.items[hit.triangle].geometry;
  const SurfaceHit surface = surfaceAt(scene, hit.instance, hit.triangle, hit.barycentrics);
  const vec3 onward = offsetRayOrigin(surface.p, surface.pError, surface.ng, c.direction);
  const RayHit second = traceClosest(scene, onward, c.direction, 0.0, kRayInfinity, key, kInvalidIndex);
  if (second.found) result.second = triangles.items[second.triangle].geometry;
  result.secondT = second.t;
  const vec3 backward = offsetRayOrigin(surface.p, surface.pError, surface.ng, -c.direction);
  const RayHit back = traceClosest(scene, backward, -c.direction, 0.0, kRayInfinity, key, kInvalidIndex);
  if (back.found) result.back = triangles.items[back.triangle].geometry;
  result.backT = back.t;
  return result;
}
