#version 460
#extension GL_GOOGLE_include_directive : require

#include "geometry/ray_offset.glsl"
#include "geometry/ray_triangle.glsl"
#include "glsl/offset_case.h"
#define PROBE_INPUT LeaveCase
#define PROBE_OUTPUT LeaveResult
#include "support/probe_main.glsl"

LeaveResult probe(const LeaveCase c) {
  const Affine worldFromObject = Affine(c.worldFromObject[0], c.worldFromObject[1], c.worldFromObject[2]);
  const Affine objectFromWorld = Affine(c.objectFromWorld[0], c.objectFromWorld[1], c.objectFromWorld[2]);
  const HitPoint hit =
      hitPointToWorld(pointOnTriangle(c.v0, c.v1, c.v2, c.barycentrics), worldFromObject, objectFromWorld);
  const vec3 scaledNormal = cross((c.v1 - c.v0) / length(c.v1 - c.v0), (c.v2 - c.v0) / length(c.v2 - c.v0));
  const vec3 ng = normalize(transformByTranspose(objectFromWorld, scaledNormal));
  const vec3 origin = offsetRayOrigin(hit.p, hit.pError, ng, c.direction);
  const TriangleRay ray =
      makeTriangleRay(transformPoint(objectFromWorld, origin), transformVector(objectFromWorld, c.direction));
  const TriangleHit again = intersectTriangle(ray, c.v0, c.v1, c.v2);
  return LeaveResult(hit.p, hit.pError, origin, again.found ? 1u : 0u);
}
