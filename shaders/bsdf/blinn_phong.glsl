// The Blinn-Phong microfacet distribution, cos^n of the normal's angle with n = 2 / alpha^2 - 2, and its exact Smith
// masking.
//
// Its slopes follow Student's distribution of n + 2 degrees of freedom. Where alpha differs along x and y, they are
// stretched from the geometric mean. Directions are unit and in the local shading frame, z the normal; alpha as in
// ggx.glsl; b = (n + 2) / 2 = 1 / alpha^2, in [1, 1e6].
#ifndef ISOPHOTE_BSDF_BLINN_PHONG_GLSL
#define ISOPHOTE_BSDF_BLINN_PHONG_GLSL

#include "math/constants.glsl"
#include "math/exponential.glsl"
#include "math/trigonometry.glsl"

/// Density of microfacet normals, per steradian, so that the integral of D cos over the hemisphere is 1.
/// Source: Blinn 1977, "Models of Light Reflection for Computer Synthesized Pictures"; normalized as in Walter et al.
/// 2007, eq. 30.
float blinnPhongD(const vec3 wm, const vec2 alpha) {
  const float z = max(wm.z, 1e-8);
  const float b = 1.0 / (alpha.x * alpha.y);
  const vec2 slope = wm.xy / (alpha * z);
  return b * kInvPi * exp(-(b + 1.0) * log1p(dot(slope, slope) / b)) / (z * z * z * z);
}

// Gamma(b + 1/2) / (Gamma(b) sqrt(pi)) for b >= 1, by the asymptotic series at b + 3.
float studentFactor(const float b) {
  const float x = 1.0 / (b + 3.0);
  const float series = 1.0 + x * (-0.125 + x * (0.0078125 + x * (0.0048828125 - x * 0.000640869141)));
  return b * (b + 1.0) * (b + 2.0) / ((b + 0.5) * (b + 1.5) * (b + 2.5)) * series * 0.564189584 * inversesqrt(x);
}

/// Mean of |cosine - sine p| over slopes p: integral of D |dot(w, wm)| over normals.
///
/// It is c I + 2 C s^(2b) / (2b - 1), I = 2 C times the integral of (1 - y^2)^(b-1) over y in [0, c], an incomplete
/// beta function, here by the hypergeometric series of positive terms around either end.
/// @param c, s2 cosine and squared sine of w
float studentMeanProjection(const float c, const float s2, const float b) {
  const float c2 = c * c;
  const bool steep = c2 < 0.5;
  const float exponent = b * (steep ? log1p(-c2) : log(max(s2, 1e-30)));
  if (exponent < -20.0) return c; // w is above all slopes
  const float tail = studentFactor(b) * exp(exponent);
  const float x = steep ? c2 : s2;
  const vec2 shift = steep ? vec2(b - 0.5, 0.5) : vec2(b - 0.5, b);
  float term = 1.0;
  float sum = 1.0;
  for (float j = 1.0; j < 128.0 && term > 1e-8 * sum; ++j) {
    term *= x * (shift.x + j) / (shift.y + j);
    sum += term;
  }
  const float beyond = 2.0 / (2.0 * b - 1.0);
  return steep ? tail * (2.0 * c2 * sum + beyond) : c + tail * (beyond - c2 * sum / b);
}

/// z (1 + 2 Lambda) of Smith's masking. Source: Heitz 2014, JCGT 3(2), eq. 14 and 43 for these slopes.
float blinnPhongProjectedLength(const vec3 w, const vec2 alpha) {
  const vec3 stretched = vec3(alpha * inversesqrt(alpha.x * alpha.y) * w.xy, w.z);
  const float size = length(stretched);
  const float c = min(w.z / size, 1.0);
  const float s2 = dot(stretched.xy, stretched.xy) / (size * size);
  return size * studentMeanProjection(c, s2, 1.0 / (alpha.x * alpha.y));
}

/// Samples microfacet normals proportionally to D cos, per steradian: cos^2 = (1 - u)^(alpha^2). Source: Walter et al.
/// 2007, eq. 31 and 32.
vec3 sampleBlinnPhongNormal(const vec2 alpha, const vec2 u) {
  const float area = alpha.x * alpha.y;
  const float tangent = sqrt(expm1(-area * log1p(-u.y)) / area); // in units of alpha
  const vec2 azimuth = sinCosPi(2.0 * u.x - 1.0).yx;
  return normalize(vec3(alpha * azimuth * tangent, 1.0));
}

#endif
