#version 460
#extension GL_GOOGLE_include_directive : require
#include "glsl/sampling_key_case.h"
#include "sampling/sampler.glsl"
#define PROBE_INPUT SamplingKeyCase
#define PROBE_OUTPUT SamplingKeyResult
#include "support/probe_main.glsl"

SamplingKeyResult probe(const SamplingKeyCase c) {
  const SampleKey key = SampleKey(c.pixel, c.sampleIndex, c.seed);
  return SamplingKeyResult(sampleBits2d(key, c.pair), sample2d(key, c.pair));
}
