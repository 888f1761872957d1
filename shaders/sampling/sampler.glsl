// Random numbers as pure functions of (pixel, sample, pair, seed): never of thread, queue position or batch.
#ifndef ISOPHOTE_SAMPLING_SAMPLER_GLSL
#define ISOPHOTE_SAMPLING_SAMPLER_GLSL

#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require // of shared/film_types.h

#include "sampling/hash.glsl"
#include "sampling/sobol.glsl"
#include "shared/constants.glsl"
#include "shared/film_types.h"

const uint kSamplerSobol = 0u; // values of kSampler, as isophote::SamplerKind
const uint kSamplerIndependent = 1u;
const uint kSamplerSobolJoint = 2u;

// Sequences that a pixel's samples take turns in.
const uint kSequenceCount = kSampler == kSamplerSobolJoint ? 1u : kReplicateCount;

struct SampleKey {
  uint pixel; // x | y << 16
  uint sampleIndex;
  uvec2 seed;
};

/// The two numbers of pair `pair`, as 32-bit fractions.
///
/// Sobol: sample s is point s / kSequenceCount of sequence s % kSequenceCount; pairs, pixels, sequences and seeds
/// differ by scrambling. Each replicate is a sequence of its own, or they share one. No two keys share all scramble
/// seeds: pcg4d is a bijection of the 128-bit key. Since every prefix of 2^m points is a net in each pair, neighbouring
/// samples lie in opposite halves in every pair: the coarsest interaction between two pairs has up to twice the
/// variance of independent numbers, all others gain or equal.
/// @param pair  below 2^29
uvec2 sampleBits2d(const SampleKey key, uint pair) {
  if (kSampler == kSamplerIndependent) {
    // Alpha tests hash the same state with four indices; none of those is ~0.
    const uvec4 state = pcg4d(uvec4(key.pixel, key.sampleIndex, key.seed));
    return pcg4d(state ^ uvec4(pair, uvec3(0xffffffffu))).xy;
  }
  const uint sequence = key.sampleIndex % kSequenceCount;
  const uvec4 scramble = pcg4d(uvec4(key.pixel, pair * kReplicateCount + sequence, key.seed));
  return owenSobol2d(key.sampleIndex / kSequenceCount, scramble.xyz);
}

/// The two numbers of pair `pair`, in [0, 1), multiples of 2^-24.
vec2 sample2d(const SampleKey key, uint pair) { return unitFloat(sampleBits2d(key, pair)); }

#endif
