// Tests on the bits of a float. isnan() and isinf() may be removed by a driver, which is free to assume that neither
// occurs (Vulkan 1.3, appendix "Precision and Operation of SPIR-V Instructions"); integer operations may not.
#ifndef ISOPHOTE_MATH_FLOAT_BITS_GLSL
#define ISOPHOTE_MATH_FLOAT_BITS_GLSL

/// Whether `x` is NaN or an infinity. Exact for every bit pattern.
bool isNonFinite(const float x) { return (floatBitsToUint(x) & 0x7f800000u) == 0x7f800000u; }

/// Whether any component is.
bool isNonFinite(const vec3 v) {
  const uvec3 exponent = floatBitsToUint(v) & 0x7f800000u;
  return any(equal(exponent, uvec3(0x7f800000u)));
}

#endif
