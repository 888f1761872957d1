#version 460
#extension GL_GOOGLE_include_directive : require
#include "glsl/sphere_light_case.h"
#include "light/sphere_light.glsl"
#define PROBE_INPUT SphereLightCase
#define PROBE_OUTPUT SphereLightResult
#include "support/probe_main.glsl"

SphereLightResult probe(const SphereLightCase c) {
  const SphereSample s = sampleSphere(c.center, c.radius, c.p, c.u);
  const SphereHit hit = intersectSphere(c.p, c.direction, c.center, c.radius, 0.0);
  return SphereLightResult(s.normal, s.wi, s.distance, s.pdfSolidAngle,
                           spherePdfSolidAngle(c.center, c.radius, c.p, s.wi), hit.found ? 1u : 0u, hit.t,
                           hit.halfChord);
}
