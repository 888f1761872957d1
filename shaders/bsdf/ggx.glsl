// The GGX microfacet distribution, its masking by Smith's model, and its visible normals.
//
// Directions are unit and in the local shading frame, z the normal. alpha is the width along x and y, equal where the
// surface is isotropic, in [1e-3, 1]. Cosines may be as small as 1e-7.
#ifndef ISOPHOTE_BSDF_GGX_GLSL
#define ISOPHOTE_BSDF_GGX_GLSL

#include "math/constants.glsl"
#include "math/trigonometry.glsl"
#include "sampling/warp.glsl"

/// Density of microfacet normals, per steradian, so that the integral of D cos over the hemisphere is 1.
///
/// Source: Heitz 2014, "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs", JCGT 3(2), eq. 84,
/// written on the normal divided by alpha: the textbook form on cos^2 cancels and loses 12% at alpha = 1e-3.
/// Accuracy: 1e-5 relative; measured in tests/glsl/ggx_test.cpp.
float ggxD(const vec3 wm, const vec2 alpha) {
  const vec3 stretched = vec3(wm.xy / alpha, wm.z);
  const float length2 = dot(stretched, stretched); // in [1, 1e6]
  return kInvPi / (alpha.x * alpha.y * length2 * length2);
}

/// z sqrt(1 + alpha^2 tan^2): Smith's Lambda is (this / z - 1) / 2. No 0 / 0 at grazing angles.
float ggxProjectedLength(const vec3 w, const vec2 alpha) { return length(vec3(alpha * w.xy, w.z)); }

/// Samples microfacet normals proportionally to D cos, per steradian of wm, seen or not.
///
/// Of alpha = 1, D is 1 / pi; slopes scale with alpha (Heitz 2014, section 5.3).
/// @param u in [0, 1)^2
/// @return  unit, z > 0
vec3 sampleGgxNormal(const vec2 alpha, const vec2 u) {
  const vec3 round = sampleCosineHemisphere(u);
  return normalize(vec3(alpha * round.xy, round.z));
}

/// Samples the normals that wo sees.
///
/// Source: Dupuy and Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps", listing 3. The cap's z and
/// radius are written on u.y so that neither is a difference of near equals.
/// @param u in [0, 1)^2
/// @return  unit, z > 0
vec3 sampleVisibleGgxNormal(const vec3 wo, const vec2 alpha, const vec2 u) {
  const vec3 stretched = vec3(alpha * wo.xy, wo.z);
  const vec3 view = stretched / length(stretched);
  // Uniform on the cap of reflected directions above -view.z: z = (1 - u.y)(1 + view.z) - view.z.
  const float height = (1.0 - u.y) * (1.0 + view.z);                         // z + view.z
  const float belowTop = u.y * (1.0 + view.z);                               // 1 - z
  const float aboveBottom = dot(view.xy, view.xy) / (1.0 + view.z) + height; // 1 + z
  const vec2 azimuth = sinCosPi(2.0 * u.x - 1.0).yx;
  const vec2 cap = azimuth * sqrt(belowTop * aboveBottom);
  return normalize(vec3(alpha * (cap + view.xy), height));
}

#endif
