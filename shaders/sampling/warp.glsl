// Maps from the unit square to the domains that a path tracer samples, each with its density.
// Every map is finite, inside its domain and of positive density for all u = k 2^-24, k in [0, 2^24).
#ifndef ISOPHOTE_SAMPLING_WARP_GLSL
#define ISOPHOTE_SAMPLING_WARP_GLSL

#include "math/constants.glsl"
#include "math/trigonometry.glsl"

/// [0,1)^2 to (-1,1)^2, sending each lattice value k 2^-24 to the middle of its cell: never -1, 0 or 1, exact in float.
vec2 centeredSquare(vec2 u) { return 2.0 * u - (1.0 - 5.9604644775390625e-8); }

/// Maps the square to the unit disk, preserving areas up to a factor and neighbourhoods.
///
/// Source: Shirley and Chiu 1997, "A Low Distortion Map Between Disk and Square", JGT 2(3).
/// @return point of radius in (0, 1); pdf is pdfUniformDisk
vec2 sampleUniformDisk(vec2 u) {
  const vec2 c = centeredSquare(u);
  const bool wide = abs(c.x) > abs(c.y);
  const float radius = wide ? c.x : c.y;
  const vec2 sinCos = sinCosPi(0.25 * (wide ? c.y / c.x : c.x / c.y)); // divisor >= 2^-24
  return radius * (wide ? sinCos.yx : sinCos);
}

/// Per unit area of the disk.
float pdfUniformDisk() { return kInvPi; }

/// Samples directions about +z proportionally to their cosine.
///
/// Source: Malley's method, a uniform disk projected up.
/// @return unit vector, z >= 3e-4; pdf is pdfCosineHemisphere(z)
vec3 sampleCosineHemisphere(vec2 u) {
  const vec2 d = sampleUniformDisk(u);
  // 1 - r^2 with r = max |c| <= 1 - 2^-24: taken from c so that the rounding of d cannot cancel.
  const vec2 c = abs(centeredSquare(u));
  const float r = max(c.x, c.y);
  return vec3(d, sqrt((1.0 - r) * (1.0 + r)));
}

/// Per steradian. @param cosine  of the angle to +z, >= 0
float pdfCosineHemisphere(float cosine) { return cosine * kInvPi; }

/// Samples all directions alike.
///
/// @return unit vector; pdf is pdfUniformSphere
vec3 sampleUniformSphere(vec2 u) {
  const vec2 c = centeredSquare(u);
  const float r = sqrt((1.0 - c.x) * (1.0 + c.x));
  const vec2 sinCos = sinCosPi(c.y);
  return vec3(r * sinCos.y, r * sinCos.x, c.x);
}

/// Per steradian.
float pdfUniformSphere() { return kInv4Pi; }

/// 1 - cos(theta) from sin^2(theta), theta in [0, pi/2], without cancellation.
float oneMinusCosFromSinSquared(float sinSquared) { return sinSquared / (1.0 + sqrt(max(1.0 - sinSquared, 0.0))); }

/// Samples the directions within an angle of +z alike.
///
/// @param oneMinusCosMax  1 - cos of the cone's half angle, in (0, 2]; small cones keep their relative precision
/// @return unit vector; pdf is pdfUniformCone(oneMinusCosMax)
vec3 sampleUniformCone(vec2 u, float oneMinusCosMax) {
  const float oneMinusCos = u.x * oneMinusCosMax;
  const float r = sqrt(oneMinusCos * (2.0 - oneMinusCos));
  const vec2 sinCos = sinCosPi(centeredSquare(u).y);
  return vec3(r * sinCos.y, r * sinCos.x, 1.0 - oneMinusCos);
}

/// Per steradian.
float pdfUniformCone(float oneMinusCosMax) { return kInvTwoPi / oneMinusCosMax; }

/// Samples a triangle's area uniformly.
///
/// Source: Heitz 2019, "A Low-Distortion Map Between Triangle and Square".
/// @return barycentric weights of the three vertices, each in [0, 1], sum 1 to rounding; pdf is 1 / area
vec3 sampleUniformTriangle(vec2 u) {
  const vec2 b = u.y > u.x ? vec2(0.5 * u.x, u.y - 0.5 * u.x) : vec2(u.x - 0.5 * u.y, 0.5 * u.y);
  return vec3(b, max(1.0 - b.x - b.y, 0.0));
}

#endif
