#version 460
#extension GL_GOOGLE_include_directive : require
#include "glsl/precision_case.h"
#include "math/float_bits.glsl"
#define PROBE_INPUT NonFiniteCase
#define PROBE_OUTPUT NonFiniteResult
#include "support/probe_main.glsl"

NonFiniteResult probe(const NonFiniteCase c) {
  const float x = uintBitsToFloat(c.bits);
  NonFiniteResult result;
  result.scalar = uint(isNonFinite(x));
  result.components =
      uint(isNonFinite(vec3(x, 1, 1))) | uint(isNonFinite(vec3(1, x, 1))) << 1 | uint(isNonFinite(vec3(1, 1, x))) << 2;
  return result;
}
