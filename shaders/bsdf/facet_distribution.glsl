// How microfacets lie and hide one another: the distribution of normals and the masking that the settings choose.
//
// Directions are unit and in the local shading frame, z the normal. alpha is the width along x and y, equal where the
// surface is isotropic, in [1e-3, 1]. Cosines may be as small as 1e-7. Formulas: docs/bsdf.md, "Facets".
#ifndef ISOPHOTE_BSDF_FACET_DISTRIBUTION_GLSL
#define ISOPHOTE_BSDF_FACET_DISTRIBUTION_GLSL

#include "bsdf/beckmann.glsl"
#include "bsdf/blinn_phong.glsl"
#include "bsdf/ggx.glsl"
#include "shared/constants.glsl"

// A direction closer to the horizon than this counts as below it: single precision cannot tell.
const float kMinCosine = 1e-7;

// Values of isophote::Ndf and isophote::Masking.
const uint kNdfGgx = 0u;
const uint kNdfBeckmann = 1u;
const uint kMaskingCorrelated = 0u;

/// Density of microfacet normals, per steradian, so that the integral of D cos over the hemisphere is 1.
float facetD(const vec3 wm, const vec2 alpha) {
  if (kNdf == kNdfGgx) return ggxD(wm, alpha);
  if (kNdf == kNdfBeckmann) return beckmannD(wm, alpha);
  return blinnPhongD(wm, alpha);
}

/// S = z (1 + 2 Lambda(w)) of Smith's model: the integral of D |dot(w, wm)| over normals. G1 = 2 z / (z + S).
float facetProjectedLength(const vec3 w, const vec2 alpha) {
  if (kNdf == kNdfGgx) return ggxProjectedLength(w, alpha);
  if (kNdf == kNdfBeckmann) return beckmannProjectedLength(w, alpha);
  return blinnPhongProjectedLength(w, alpha);
}

/// G2 / (4 cos wo cos wi): masking and shadowing correlated by height, or the product of both as if they were
/// independent. No 0 / 0 at grazing angles.
/// Source: Heitz 2014, "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs", JCGT 3(2), eq. 99 and
/// 98, multiplied out.
float facetVisibility(const vec3 wo, const vec3 wi, const vec2 alpha) {
  const float lengthO = facetProjectedLength(wo, alpha);
  const float lengthI = facetProjectedLength(wi, alpha);
  if (kMasking == kMaskingCorrelated) return 0.5 / (wi.z * lengthO + wo.z * lengthI);
  return 1.0 / ((wo.z + lengthO) * (wi.z + lengthI));
}

/// Samples microfacet normals proportionally to D cos, per steradian of wm, seen or not.
/// @param u in [0, 1)^2
/// @return  unit, z > 0
vec3 sampleFacetNormal(const vec2 alpha, const vec2 u) {
  if (kNdf == kNdfGgx) return sampleGgxNormal(alpha, u);
  if (kNdf == kNdfBeckmann) return sampleBeckmannNormal(alpha, u);
  return sampleBlinnPhongNormal(alpha, u);
}

/// Density of sampleVisibleNormal, per steradian of wm: of GGX by Smith's masking, else by that of V-cavities.
/// Source: Heitz 2014, eq. 16 with G1 of eq. 86, and of Heitz and d'Eon 2014, "Importance Sampling Microfacet-Based
/// BSDFs using the Distribution of Visible Normals", section 4.
float pdfVisibleNormal(const vec3 wo, const vec3 wm, const vec2 alpha) {
  if (kNdf == kNdfGgx) {
    return 2.0 * max(dot(wo, wm), 0.0) * ggxD(wm, alpha) / (wo.z + ggxProjectedLength(wo, alpha));
  }
  return facetD(wm, alpha) * min(max(dot(wo, wm), 0.0) / wo.z, 2.0 * wm.z);
}

/// Density of the reflection of wo about a sampled visible normal wm, per steradian of wi.
/// Source: Heitz 2014, eq. 17: pdfVisibleNormal / (4 dot(wo, wm)).
float pdfVisibleReflection(const vec3 wo, const vec3 wm, const vec2 alpha) {
  if (kNdf == kNdfGgx) return 0.5 * ggxD(wm, alpha) / (wo.z + ggxProjectedLength(wo, alpha));
  return facetD(wm, alpha) * min(0.25 / wo.z, 0.5 * wm.z / max(dot(wo, wm), 1e-8));
}

/// Samples the normals that wo sees. Of V-cavities it sees one of two that mirror each other, each by its projection
/// (Heitz and d'Eon 2014, algorithm 3).
///
/// @param u     in [0, 1)^2
/// @param range of uSide
/// @param uSide in [0, range), chooses between the two; what is left of it is uniform there again
/// @return      unit, z > 0
vec3 sampleVisibleNormal(const vec3 wo, const vec2 alpha, const vec2 u, const float range, inout float uSide) {
  if (kNdf == kNdfGgx) return sampleVisibleGgxNormal(wo, alpha, u);
  const vec3 wm = sampleFacetNormal(alpha, u);
  const vec3 mirrored = vec3(-wm.xy, wm.z);
  const float seen = max(dot(wo, wm), 0.0);
  const float first = range * (seen / (seen + max(dot(wo, mirrored), 0.0))); // the divisor is at least 2 z z
  const bool isFirst = uSide < first;
  uSide = isFirst ? uSide * (range / first) : (uSide - first) * (range / (range - first));
  uSide = min(uSide, range * 0.99999994);
  return isFirst ? wm : mirrored;
}

#endif
