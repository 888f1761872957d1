#version 460
#extension GL_GOOGLE_include_directive : require

#include "geometry/traverse.glsl"
#include "glsl/traversal_case.h"
#define PROBE_INPUT TraversalCase
#define PROBE_OUTPUT TraversalResult
#include "support/probe_main.glsl"

TraversalResult probe(const TraversalCase c) {
  SceneRef scene = SceneRef(pc.extra);
  const AlphaKey key = AlphaKey(c.pixel, c.sampleIndex, uvec2(1u, 2u), c.vertex);
  const RayHit hit = traceClosest(scene, c.origin, c.direction, c.tMin, c.tMax, key, kInvalidIndex);
  bool overflow;
  const bool occluded = traceOccluded(scene, c.origin, c.direction, c.tMin, c.tMax, key, kInvalidIndex, overflow);
  TraversalResult result = TraversalResult(hit.t, hit.instance, hit.triangle, hit.barycentrics, hit.found ? 1u : 0u,
                                           occluded ? 1u : 0u, hit.stackOverflow || overflow ? 1u : 0u, 0u, 0u);
  if (hit.found) {
    result.geometry = BvhTriangleRef(scene.view.triangles).items[hit.triangle].geometry;
    result.primitiveIndex = BvhTriangleRef(scene.view.triangles).items[hit.triangle].primitiveIndex;
  }
  return result;
}
