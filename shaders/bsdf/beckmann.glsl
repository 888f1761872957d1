// The Beckmann microfacet distribution: slopes are normally distributed, of variance alpha^2 / 2 along x and y.
//
// Directions are unit and in the local shading frame, z the normal; alpha as in ggx.glsl.
#ifndef ISOPHOTE_BSDF_BECKMANN_GLSL
#define ISOPHOTE_BSDF_BECKMANN_GLSL

#include "math/constants.glsl"
#include "math/exponential.glsl"
#include "math/trigonometry.glsl"

/// Density of microfacet normals, per steradian, so that the integral of D cos over the hemisphere is 1.
/// Source: Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces", eq. 25.
float beckmannD(const vec3 wm, const vec2 alpha) {
  const float z = max(wm.z, 1e-8);
  const vec2 slope = wm.xy / (alpha * z);
  return exp(-dot(slope, slope)) * kInvPi / (alpha.x * alpha.y * z * z * z * z);
}

/// erf(x) for x >= 0. Source: Abramowitz and Stegun 1964, 7.1.26. Accuracy: 3e-7 absolute.
float errorFunction(const float x) {
  const float t = 1.0 / (1.0 + 0.3275911 * x);
  const float p = 0.254829592 + t * (-0.284496736 + t * (1.421413741 + t * (-1.453152027 + t * 1.061405429)));
  return 1.0 - t * p * exp(-x * x);
}

/// z (1 + 2 Lambda) of Smith's masking. Source: Heitz 2014, JCGT 3(2), eq. 72 and 80, multiplied out.
float beckmannProjectedLength(const vec3 w, const vec2 alpha) {
  const float across = length(alpha * w.xy);
  if (across < 1e-4 * w.z) return w.z;
  const float a = min(w.z / across, 10.0);
  return w.z * errorFunction(a) + across * 0.564189584 * exp(-a * a); // 1 / sqrt(pi)
}

/// Samples microfacet normals proportionally to D cos, per steradian. Source: Walter et al. 2007, eq. 28 and 29.
vec3 sampleBeckmannNormal(const vec2 alpha, const vec2 u) {
  const float tangent = sqrt(-log1p(-u.y)); // in units of alpha
  const vec2 azimuth = sinCosPi(2.0 * u.x - 1.0).yx;
  return normalize(vec3(alpha * azimuth * tangent, 1.0));
}

#endif
