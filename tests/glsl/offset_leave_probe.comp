#version 460
#extension GL_GOOGLE_include_directive : require

#include "geometry/ray_offset.glsl"
#include "geometry/ray_triangle.glsl"
#include "glsl/offset_case.h"
#include "math/normalize.glsl"
#define PROBE_INPUT LeaveCase
#define PROBE_OUTPUT LeaveResult
#include "support/probe_main.glsl"

LeaveResult probe(const LeaveCase c) {
  const Affine worldFromObject = Affine(c.worldFromObject[0], c.worldFromObject[1], c.worldFromObject[2]);
  const Affine objectFromWorld = Affine(c.objectFromWorld[0], c.objectFromWorld[1], c.objectFromWorld[2]);
  const HitPoint object = pointOnTriangle(c.v0, c.v1, c.v2, c.barycentrics);
  const HitPoint hit = hitPointToWorld(object, worldFromObject, objectFromWorld);
  const vec3 normal = crossEdges(c.v1 - c.v0, c.v2 - c.v1, c.v0 - c.v2).value;
  const vec3 ng = safeNormalize(transformByTranspose(objectFromWorld, normal), vec3(0.0, 0.0, 1.0));
  const vec3 origin = offsetRayOrigin(hit.p, hit.pError, ng, c.direction);
  const vec3 originObject = transformPoint(objectFromWorld, origin);
  const TriangleRay ray = makeTriangleRay(originObject, transformVector(objectFromWorld, c.direction));
  const TriangleHit again = intersectTriangle(ray, c.v0, c.v1, c.v2);
  const TriangleHit other = intersectTriangle(ray, c.v0 + c.neighbor, c.v1 + c.neighbor, c.v2 + c.neighbor);
  return LeaveResult(object.p, object.pError, hit.p, hit.pError, originObject, again.found ? 1u : 0u,
                     other.found ? 1u : 0u);
}
