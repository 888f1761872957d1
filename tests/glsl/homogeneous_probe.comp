#version 460
#extension GL_GOOGLE_include_directive : require
#include "glsl/homogeneous_case.h"
#include "medium/homogeneous.glsl"
#define PROBE_INPUT HomogeneousCase
#define PROBE_OUTPUT HomogeneousResult
#include "support/probe_main.glsl"

HomogeneousResult probe(const HomogeneousCase c) {
  const DistanceSample found = sampleDistance(Medium(c.extinction, c.albedo, 0.0), c.beta, c.limit, c.bits);
  return HomogeneousResult(transmittance(c.extinction, c.limit), sampleOpticalDepth(c.bits.y), found.weight,
                           found.distance, found.scattered ? 1u : 0u);
}
