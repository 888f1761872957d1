#version 460
#extension GL_GOOGLE_include_directive : require
#include "glsl/henyey_greenstein_case.h"
#include "medium/henyey_greenstein.glsl"
#define PROBE_INPUT HenyeyGreensteinCase
#define PROBE_OUTPUT HenyeyGreensteinResult
#include "support/probe_main.glsl"

HenyeyGreensteinResult probe(const HenyeyGreensteinCase c) {
  const vec3 sampled = sampleHenyeyGreenstein(c.wo, c.g, c.u);
  return HenyeyGreensteinResult(evalHenyeyGreenstein(c.wo, c.wi, c.g), sampled,
                                evalHenyeyGreenstein(c.wo, sampled, c.g));
}
