// Steps in the representation of floats: exponents and neighbors.
#ifndef ISOPHOTE_GEOMETRY_FLOAT_STEPS_GLSL
#define ISOPHOTE_GEOMETRY_FLOAT_STEPS_GLSL

// The relative error of one rounding. Vulkan leaves the rounding mode open, hence twice the familiar 2^-24. A chain of
// n roundings stays within gamma(n) = n e / (1 - n e) <= 1.00001 n e for n < 80 (Higham 2002, lemma 3.1).
const float kRoundingError = 1.1920929e-7; // 2^-23

/// 2^-n for n = floor(log2 x), n clamped to [-126, 126]: x times it is in [1, 2) unless the clamp acted.
/// @param x  finite, >= 0
float powerOfTwoInverse(const float x) {
  const uint exponent = clamp((floatBitsToUint(x) >> 23u) & 0xffu, 1u, 253u);
  return uintBitsToFloat((254u - exponent) << 23u);
}

/// The next float towards +infinity. -0 counts as 0.
/// @param x  finite
float nextFloatUp(const float x) {
  const uint bits = floatBitsToUint(x);
  if (bits == 0u || bits == 0x80000000u) return uintBitsToFloat(1u);
  return uintBitsToFloat((bits & 0x80000000u) == 0u ? bits + 1u : bits - 1u);
}

/// The next float towards -infinity.
/// @param x  finite
float nextFloatDown(const float x) { return -nextFloatUp(-x); }

#endif
