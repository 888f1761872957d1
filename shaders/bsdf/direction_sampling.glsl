// How a path's next direction is drawn: lobe by lobe as the BSDF is made, or by one of the textbook's techniques, which
// differ in noise alone (the setting direction-sampling). Formulas: docs/bsdf.md.
//
// Directions are unit and in the local shading frame, z the shading normal on wo's side.
#ifndef ISOPHOTE_BSDF_DIRECTION_SAMPLING_GLSL
#define ISOPHOTE_BSDF_DIRECTION_SAMPLING_GLSL

#include "bsdf/facet_distribution.glsl"
#include "bsdf/surface_bsdf.glsl"
#include "sampling/warp.glsl"
#include "shared/constants.glsl"

// Values of isophote::DirectionSampling.
const uint kDirectionsByLobe = 0u;
const uint kDirectionsUniform = 1u;
const uint kDirectionsCosine = 2u;
const uint kDirectionsNdf = 3u;
const uint kDirectionsVisibleNormals = 4u;
const uint kDirectionsMixture = 5u; // of the four before, a quarter each

/// Returns the share of directions that are drawn lobe by lobe all the same: half where a technique alone cannot draw
/// all that the surface scatters, which is its delta lobes and what lies behind it.
float lobesShare(const SurfaceBsdf bsdf) {
  const bool coated = kHasClearcoat && bsdf.coat.amount > 0.0 && coatIsMirror(bsdf.coat);
  const bool needsLobes = isMirror(bsdf.base) || coated || transmits(bsdf);
  return needsLobes ? 0.5 : 0.0;
}

// Width of the facets whose normals are drawn: those of the base.
vec2 techniqueWidth(const SurfaceBsdf bsdf) { return max(bsdf.base.width, vec2(kNarrowestAlpha)); }

/// Returns the density of a technique's directions above the surface, per steradian of wi.
///
/// Source: of reflected normals, Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces", eq. 14
/// and 24; of visible ones, Heitz 2014, eq. 16 and 17.
/// @param technique any but kDirectionsByLobe
float pdfTechnique(const uint technique, const SurfaceBsdf bsdf, const vec3 woLocal, const vec3 wiLocal) {
  if (wiLocal.z < kMinCosine) return 0.0;
  if (technique == kDirectionsUniform) return kInvTwoPi;
  const float cosine = pdfCosineHemisphere(wiLocal.z);
  if (technique == kDirectionsCosine) return cosine;
  const vec2 width = techniqueWidth(bsdf);
  const vec3 sum = woLocal + wiLocal;
  const float twoCosine = length(sum); // 2 dot(wo, wm)
  const vec3 wm = sum / twoCosine;
  const float ndf = facetD(wm, width) * wm.z / (2.0 * twoCosine);
  if (technique == kDirectionsNdf) return ndf;
  const float visible = pdfVisibleReflection(woLocal, wm, width);
  if (technique == kDirectionsVisibleNormals) return visible;
  return 0.25 * (kInvTwoPi + cosine + ndf + visible);
}

/// Samples a direction by a technique; it may lie below the surface.
///
/// @param uTechnique in [0, 1), chooses among those of a mixture
/// @param u          in [0, 1)^2
vec3 sampleTechnique(const uint technique, const SurfaceBsdf bsdf, const vec3 woLocal, const float uTechnique,
                     const vec2 u) {
  const bool isMixture = technique == kDirectionsMixture;
  const uint one = isMixture ? kDirectionsUniform + uint(4.0 * uTechnique) : technique;
  if (one == kDirectionsUniform) return sampleUniformCone(u, 1.0);
  if (one == kDirectionsCosine) return sampleCosineHemisphere(u);
  const vec2 width = techniqueWidth(bsdf);
  float uSide = isMixture ? fract(4.0 * uTechnique) : uTechnique;
  const vec3 wm =
      one == kDirectionsNdf ? sampleFacetNormal(width, u) : sampleVisibleNormal(woLocal, width, u, 1.0, uSide);
  return normalize(2.0 * dot(woLocal, wm) * wm - woLocal);
}

/// Returns f |cos wi| and the density of sampleDirection's continuous part.
/// @param at bsdfAtWo of wo
BsdfValue evaluateDirection(const SceneRef scene, const SurfaceBsdf bsdf, const BsdfAtWo at, const vec3 woLocal,
                            const vec3 wiLocal) {
  BsdfValue value = evaluateBsdf(scene, bsdf, at, woLocal, wiLocal);
  if (kDirectionSampling == kDirectionsByLobe) return value;
  const float lobes = lobesShare(bsdf);
  value.pdfSolidAngle =
      lobes * value.pdfSolidAngle + (1.0 - lobes) * pdfTechnique(kDirectionSampling, bsdf, woLocal, wiLocal);
  return value;
}

// By a technique alone.
BsdfSample drawByTechnique(const SurfaceBsdf bsdf, const vec3 woLocal, const float uTechnique, const vec2 u) {
  if (woLocal.z < kMinCosine) return absorbed();
  const vec3 wi = sampleTechnique(kDirectionSampling, bsdf, woLocal, uTechnique, u);
  return wi.z < kMinCosine ? absorbed() : drawnDirection(wi, 1.0);
}

/// Samples the direction in which a path goes on, weighed over everything that might have drawn it.
///
/// @param at    bsdfAtWo of wo
/// @param uLobe in [0, 1), chooses the technique and its lobe
/// @param u     in [0, 1)^2
BsdfSample sampleDirection(const SceneRef scene, const SurfaceBsdf bsdf, const BsdfAtWo at, const vec3 woLocal,
                           float uLobe, const vec2 u) {
  float lobes = 1.0;
  bool byLobes = true;
  if (kDirectionSampling != kDirectionsByLobe) {
    lobes = lobesShare(bsdf);
    byLobes = uLobe < lobes;
    uLobe = byLobes ? uLobe / lobes : min((uLobe - lobes) / (1.0 - lobes), 0.99999994);
  }
  BsdfSample drawn;
  if (byLobes) {
    drawn = drawBsdf(scene, bsdf, at, woLocal, uLobe, u);
    if (kDirectionSampling != kDirectionsByLobe && drawn.delta) drawn.weight /= lobes;
  } else {
    drawn = drawByTechnique(bsdf, woLocal, uLobe, u);
  }
  if (!drawn.valid) return drawn;
  if ((kHasSpecular || kHasLayers) && drawn.delta) return drawn; // Lambert lobes have none
  return weighed(drawn, evaluateDirection(scene, bsdf, at, woLocal, drawn.wiLocal));
}

#endif
