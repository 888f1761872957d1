#version 460
#extension GL_GOOGLE_include_directive : require
#include "glsl/sampling_warp_case.h"
#include "sampling/warp.glsl"
#define PROBE_INPUT SamplingWarpCase
#define PROBE_OUTPUT SamplingWarpResult
#include "support/probe_main.glsl"

SamplingWarpResult probe(const SamplingWarpCase c) {
  if (c.warp == kWarpDisk) return SamplingWarpResult(vec3(sampleUniformDisk(c.u), 0.0), pdfUniformDisk());
  if (c.warp == kWarpCosineHemisphere) {
    const vec3 direction = sampleCosineHemisphere(c.u);
    return SamplingWarpResult(direction, pdfCosineHemisphere(direction.z));
  }
  if (c.warp == kWarpSphere) return SamplingWarpResult(sampleUniformSphere(c.u), pdfUniformSphere());
  if (c.warp == kWarpCone) {
    return SamplingWarpResult(sampleUniformCone(c.u, c.oneMinusCosMax), pdfUniformCone(c.oneMinusCosMax));
  }
  return SamplingWarpResult(sampleUniformTriangle(c.u), 2.0); // of the triangle with corners 0, x, y
}
