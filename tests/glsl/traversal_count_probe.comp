#version 460
#extension GL_GOOGLE_include_directive : require

#define ISOPHOTE_COUNT_STEPS
#include "geometry/traverse.glsl"
#include "glsl/traversal_case.h"
#define PROBE_INPUT TraversalCase
#define PROBE_OUTPUT StepCountResult
#include "support/probe_main.glsl"

StepCountResult probe(const TraversalCase c) {
  SceneRef scene = SceneRef(pc.extra);
  const AlphaKey key = AlphaKey(c.pixel, c.sampleIndex, uvec2(1u, 2u), c.vertex);
  raySteps = RaySteps(0u, 0u, 0u, 0u);
  traceClosest(scene, c.origin, c.direction, c.tMin, c.tMax, key, kInvalidIndex);
  const RaySteps closest = raySteps;
  raySteps = RaySteps(0u, 0u, 0u, 0u);
  bool overflow;
  traceOccluded(scene, c.origin, c.direction, c.tMin, c.tMax, key, kInvalidIndex, overflow);
  return StepCountResult(uint[2](closest.turns, raySteps.turns), uint[2](closest.nodes, raySteps.nodes),
                         uint[2](closest.triangles, raySteps.triangles),
                         uint[2](closest.instances, raySteps.instances));
}
