#version 460
#extension GL_GOOGLE_include_directive : require
#include "glsl/spherical_triangle_case.h"
#include "light/spherical_triangle.glsl"
#define PROBE_INPUT SphericalTriangleCase
#define PROBE_OUTPUT SphericalTriangleResult
#include "support/probe_main.glsl"

SphericalTriangleResult probe(const SphericalTriangleCase c) {
  const SphericalTriangle t = sphericalTriangle(c.p, c.v0, c.v1, c.v2);
  SphericalTriangleResult result;
  result.solidAngle = t.solidAngle;
  result.stable = uint(isStable(t));
  result.barycentrics = isStable(t) ? sampleSphericalTriangle(t, c.u) : vec3(0.0);
  return result;
}
