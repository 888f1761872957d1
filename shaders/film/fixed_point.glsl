// Real numbers to the Film's 64-bit fixed point.
#ifndef ISOPHOTE_FILM_FIXED_POINT_GLSL
#define ISOPHOTE_FILM_FIXED_POINT_GLSL

#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require

// Largest magnitude stored for one sample, 2^62.
const float kFixedPointLimit = 4611686018427387904.0;

/// Rounds `scaled` to an integer, up with probability equal to its fraction: the expectation is exact.
///
/// @param scaled  finite, in fixed-point units; beyond +-kFixedPointLimit it is clipped
/// @param dither  32 uniform random bits
int64_t toFixedPoint(const float scaled, const uint dither) {
  const float clipped = clamp(scaled, -kFixedPointLimit, kFixedPointLimit);
  const float whole = floor(clipped);
  const float fraction = clipped - whole; // exact: both share an exponent or fraction is 0
  const float threshold = float(dither >> 8u) * 5.9604644775390625e-8;
  return int64_t(whole) + (fraction > threshold ? 1l : 0l);
}

#endif
