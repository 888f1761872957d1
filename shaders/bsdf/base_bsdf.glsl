// The scattering of a surface's base: the glTF 2.0 metallic-roughness model with transmission, made energy conserving
// and reciprocal. Formulas: docs/bsdf.md.
//
// Directions are unit and in the local shading frame, z the shading normal on wo's side; wi.z < 0: transmitted.
#ifndef ISOPHOTE_BSDF_BASE_BSDF_GLSL
#define ISOPHOTE_BSDF_BASE_BSDF_GLSL

#include "bsdf/base_shares.glsl"
#include "bsdf/dielectric_interface.glsl"
#include "bsdf/facet_distribution.glsl"
#include "math/constants.glsl"
#include "sampling/warp.glsl"
#include "shared/constants.glsl"

// Whether there may be anything on the other side of a surface.
const bool kHasFarSide = kHasTransmission || kHasDiffuseTransmission;

/// Of the base's continuous lobes, f |cos wi| in two parts, which the layers above pass differently.
struct BaseValue {
  vec3 facets;         // of microfacets, scattering between opaque ones included
  vec3 diffuse;        // of the diffuse lobe, and scattering between facets of glass
  float pdfSolidAngle; // of drawBase, per steradian of wi
};

/// Of the continuous lobes. f scatters radiance: across a boundary of index ratio eta it carries the factor 1 / eta^2.
struct BsdfValue {
  vec3 fCos;           // f |cos wi|
  float pdfSolidAngle; // of drawBsdf, per steradian of wi
};

/// A direction of scattering. The functions draw… leave the weight and density of a continuous one to weighed().
struct BsdfSample {
  vec3 wiLocal;
  vec3 weight;         // f |cos wi| / pdf over all continuous lobes; for the delta lobe reflectance / its probability
  float pdfSolidAngle; // of all continuous lobes; 0 for the delta lobe
  bool delta;
  bool valid; // false: absorbed
  float eta;  // index on wi's side over the index on wo's: 1 unless the sample is refracted
};

BaseValue noScattering() { return BaseValue(vec3(0.0), vec3(0.0), 0.0); }

// The lobes on wo's side: diffuse, multiple scattering, and the reflection by facets.
BaseValue evaluateReflection(const SceneRef scene, const MetallicRoughness m, const BaseShares shares,
                             const vec3 woLocal, const vec3 wiLocal) {
  const vec2 albedo = facetAlbedo(scene, m, wiLocal);
  const float lost = lostBetweenFacets(albedo);
  const vec3 entering = coatTransmissionAt(scene, m, wiLocal.z, albedo, shares.coatMultiple, lost);
  const float cosine = kInvPi * wiLocal.z;
  BaseValue value;
  const float staying = m.diffuse * (1.0 - crossingShare(m.behind));
  value.diffuse = m.baseColor * (staying * (shares.coat * entering / shares.meanCoat) * cosine);
  value.facets = shares.multiple * (shares.lost * lost / shares.meanLost * cosine);
  if (kHasTransmission && m.glass > 0.0) {
    const GlassMultiple glass = shares.glass;
    const float continued = glass.lost * glassLossAt(scene, m, wiLocal, false) / glass.meanInFront;
    value.diffuse += m.glass * (1.0 - glass.transmitted) * continued * cosine;
  }
  value.pdfSolidAngle = max(1.0 - shares.facetProbability - shares.behindProbability, 0.0) * cosine;
  if (!isMirror(m)) {
    const vec3 sum = woLocal + wiLocal;
    const float twoCosine = length(sum); // 2 dot(wo, wm) of unit directions: the same from both sides to the last bit
    const vec3 wm = sum / twoCosine;
    const vec2 width = m.width;
    const float shape = facetD(wm, width) * facetVisibility(woLocal, wiLocal, width) * wiLocal.z;
    const FacetScattering facet = scatterAtFacet(m, 0.5 * twoCosine);
    value.facets += facet.reflected * shape;
    value.pdfSolidAngle += shares.facetProbability * facet.reflectedShare * pdfVisibleReflection(woLocal, wm, width);
  }
  return value;
}

// Transmission by single facets, wi.z < 0: of thin walls the reflection mirrored to the other side, else refraction.
// The density is that of choosing them with `probability`.
// Source: Walter et al. 2007, eq. 21, for radiance; KHR_materials_transmission.
BaseValue evaluateFacetTransmission(const MetallicRoughness m, const float probability, const vec3 woLocal,
                                    const vec3 wiLocal) {
  const vec2 width = m.width;
  const vec3 above = vec3(wiLocal.xy, -wiLocal.z);
  vec3 wm;
  float cosine;   // between wo and wm
  float jacobian; // times eta^2: steradians of wm per steradian of wi
  if (m.thinWalled) {
    const vec3 sum = woLocal + above;
    const float twoCosine = length(sum);
    wm = sum / twoCosine;
    cosine = 0.5 * twoCosine;
  } else {
    const RefractingFacet refracting = refractingFacet(woLocal, wiLocal, m.eta);
    if (!refracting.valid) return noScattering();
    wm = refracting.wm;
    cosine = refracting.cosO;
    jacobian = refracting.jacobian;
  }
  const FacetScattering facet = scatterAtFacet(m, cosine);
  float shape = facetD(wm, width) * (facetVisibility(woLocal, above, width) * above.z);
  float density;
  if (m.thinWalled) {
    density = pdfVisibleReflection(woLocal, wm, width);
  } else {
    shape *= 4.0 * cosine * jacobian;
    density = pdfVisibleNormal(woLocal, wm, width) * m.eta * m.eta * jacobian;
  }
  return BaseValue(facet.transmitted * shape, vec3(0.0), probability * (1.0 - facet.reflectedShare) * density);
}

// Index behind over in front, of directions.
float refractedEta(const MetallicRoughness m) { return m.thinWalled ? 1.0 : m.eta; }

// The same of the cosine lobe on the other side; of glass both are equal.
float broadEta(const MetallicRoughness m) {
  return kHasDiffuseTransmission && m.behind.share > 0.0 ? m.behind.eta : refractedEta(m);
}

// The lobes on the other side.
BaseValue evaluateTransmission(const SceneRef scene, const MetallicRoughness m, const BaseShares shares,
                               const vec3 woLocal, const vec3 wiLocal) {
  BaseValue value = noScattering();
  const float cosine = -kInvPi * wiLocal.z;
  if (kHasTransmission && m.glass > 0.0 && !transmitsDelta(m)) {
    value = evaluateFacetTransmission(m, shares.facetProbability, woLocal, wiLocal);
    const GlassMultiple glass = shares.glass;
    const float eta = refractedEta(m);
    const float continued = glass.lost * glassLossAt(scene, m, wiLocal, true) / (glass.meanBehind * eta * eta);
    value.diffuse = m.baseColor * (m.glass * glass.transmitted * continued * cosine);
  }
  if (kHasDiffuseTransmission && m.behind.share > 0.0) { // both faces are coated alike
    const vec2 albedo = facetAlbedo(scene, m, wiLocal);
    const vec3 leaving =
        coatTransmissionAt(scene, m, -wiLocal.z, albedo, shares.coatMultiple, lostBetweenFacets(albedo));
    value.diffuse += crossingReflectance(m.behind) * (m.diffuse * (shares.coat * leaving / shares.meanCoat) * cosine);
  }
  value.pdfSolidAngle += shares.behindProbability * cosine;
  return value;
}

// Of Lambert lobes alone: the probability of sampling the one on the other side.
float lambertBehindProbability(const MetallicRoughness m) {
  const float behind = m.diffuse * crossingShare(m.behind) * luminance(m.behind.color);
  const float above = m.diffuse * (1.0 - crossingShare(m.behind)) * luminance(m.baseColor);
  return behind > 0.0 ? behind / (above + behind) : 0.0;
}

/// Returns f |cos wi| and the sampling density of the continuous lobes of both sides; zeros where wo is below the
/// surface.
/// @param shares baseShares of m and wo; of Lambert lobes alone nothing
BaseValue evaluateBase(const SceneRef scene, const MetallicRoughness m, const BaseShares shares, const vec3 woLocal,
                       const vec3 wiLocal) {
  const bool transmitted = kHasFarSide && wiLocal.z < 0.0;
  if (min(woLocal.z, transmitted ? -wiLocal.z : wiLocal.z) < kMinCosine) return noScattering();
  if (kHasSpecular) {
    if (transmitted) return evaluateTransmission(scene, m, shares, woLocal, wiLocal);
    return evaluateReflection(scene, m, shares, woLocal, wiLocal);
  }
  if (!kHasDiffuseTransmission) {
    const float density = kInvPi * wiLocal.z;
    return BaseValue(vec3(0.0), m.baseColor * (m.diffuse * density), density);
  }
  const float density = kInvPi * abs(wiLocal.z);
  const float behind = lambertBehindProbability(m);
  if (transmitted) {
    return BaseValue(vec3(0.0), crossingReflectance(m.behind) * (m.diffuse * density), behind * density);
  }
  const float staying = m.diffuse * (1.0 - crossingShare(m.behind));
  return BaseValue(vec3(0.0), m.baseColor * (staying * density), (1.0 - behind) * density);
}

BsdfSample absorbed() { return BsdfSample(vec3(0.0, 0.0, 1.0), vec3(0.0), 0.0, false, false, 1.0); }

BsdfSample drawnDirection(const vec3 wiLocal, const float eta) {
  return BsdfSample(wiLocal, vec3(0.0), 0.0, false, true, eta);
}

/// A continuous sample weighed by all that may have drawn its direction.
BsdfSample weighed(BsdfSample drawn, const BsdfValue value) {
  drawn.pdfSolidAngle = value.pdfSolidAngle;
  drawn.weight = value.pdfSolidAngle > 0.0 ? value.fCos / value.pdfSolidAngle : vec3(0.0);
  drawn.valid = largest(drawn.weight) > 0.0;
  return drawn;
}

// A direction to the other side through a facet of normal wm, where transmission was chosen.
BsdfSample drawFacetTransmission(const MetallicRoughness m, const BaseShares shares, const FacetScattering facet,
                                 const vec3 woLocal, const vec3 wm, const float cosine) {
  const float eta = refractedEta(m);
  if (transmitsDelta(m)) {
    const vec3 wi = m.thinWalled ? -woLocal : refractAbout(woLocal, wm, cosine, m.eta);
    const float probability = shares.facetProbability * (1.0 - facet.reflectedShare);
    const vec3 weight = facet.transmitted / (probability * eta * eta);
    return BsdfSample(wi, weight, 0.0, true, wi.z < -kMinCosine && largest(weight) > 0.0, eta);
  }
  vec3 wi;
  if (m.thinWalled) {
    wi = normalize(2.0 * cosine * wm - woLocal);
    wi.z = -wi.z;
  } else {
    wi = refractAbout(woLocal, wm, cosine, m.eta);
  }
  return wi.z > -kMinCosine ? absorbed() : drawnDirection(wi, eta);
}

// A direction by a visible facet: its reflection, or its transmission.
BsdfSample drawFromFacet(const MetallicRoughness m, const BaseShares shares, const vec3 woLocal, float uLobe,
                         const vec2 u) {
  vec3 wm = vec3(0.0, 0.0, 1.0);
  if (!isMirror(m)) wm = sampleVisibleNormal(woLocal, m.width, u, shares.facetProbability, uLobe);
  const float cosine = dot(woLocal, wm);
  const FacetScattering facet = scatterAtFacet(m, cosine);
  if (kHasTransmission && uLobe >= shares.facetProbability * facet.reflectedShare) {
    return drawFacetTransmission(m, shares, facet, woLocal, wm, cosine);
  }
  if (isMirror(m)) {
    const vec3 weight = facet.reflected / (shares.facetProbability * facet.reflectedShare);
    return BsdfSample(vec3(-woLocal.xy, woLocal.z), weight, 0.0, true, true, 1.0);
  }
  const vec3 wi = normalize(2.0 * cosine * wm - woLocal);
  return wi.z < kMinCosine ? absorbed() : drawnDirection(wi, 1.0);
}

/// Draws a direction of scattering: the cosine lobe of either side or a visible facet by their shares of the albedo, at
/// the facet reflection or transmission.
///
/// @param woLocal above the surface
/// @param uLobe   in [0, 1), chooses the lobe
/// @param u       in [0, 1)^2
BsdfSample drawBase(const MetallicRoughness m, const BaseShares shares, const vec3 woLocal, const float uLobe,
                    const vec2 u) {
  if (kHasSpecular && uLobe < shares.facetProbability) return drawFromFacet(m, shares, woLocal, uLobe, u);
  vec3 wi = sampleCosineHemisphere(u);
  float eta = 1.0;
  if (kHasSpecular) {
    if (kHasFarSide && uLobe < shares.facetProbability + shares.behindProbability) {
      wi.z = -wi.z;
      eta = broadEta(m);
    }
  } else if (kHasDiffuseTransmission && uLobe < lambertBehindProbability(m)) {
    wi.z = -wi.z;
    eta = m.behind.eta;
  }
  return drawnDirection(wi, eta);
}

#endif
