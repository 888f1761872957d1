#ifndef ISOPHOTE_MATH_NORMALIZE_GLSL
#define ISOPHOTE_MATH_NORMALIZE_GLSL

/// Normalises where the built-in would overflow (length above 1.8e19) or underflow (below 1e-19).
///
/// @param v         finite, magnitude of every component below 2^126
/// @param fallback  unit vector returned where v is shorter than 1e-36
/// @return          unit vector to 4 ulp
vec3 safeNormalize(vec3 v, vec3 fallback) {
  const float largest = max(abs(v.x), max(abs(v.y), abs(v.z)));
  if (!(largest > 1e-36)) return fallback; // keeps the divisor above 2^-126
  const vec3 scaled = v / largest;         // squared length in [1, 3]
  return scaled * inversesqrt(dot(scaled, scaled));
}

#endif
