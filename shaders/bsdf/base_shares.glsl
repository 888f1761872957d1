// What the lobes of the base do with light from wo, and the probabilities of sampling them. Formulas: docs/bsdf.md.
#ifndef ISOPHOTE_BSDF_BASE_SHARES_GLSL
#define ISOPHOTE_BSDF_BASE_SHARES_GLSL

#include "bsdf/base_albedo.glsl"
#include "bsdf/glass_loss.glsl"
#include "shared/constants.glsl"

// Where indices are this close for the roughness, refraction spreads light less than single precision can evaluate: its
// facet is known to 1e-7 / |eta - 1|, which must be small against alpha. Such a lobe is sampled and never evaluated, as
// a delta lobe, and masks nothing: surfaces of index 1 are invisible.
const float kMinRefractionSpread = 2e-4;

bool transmitsDelta(const MetallicRoughness m) {
  return isMirror(m) || (!m.thinWalled && m.alpha * abs(m.eta - 1.0) < kMinRefractionSpread * max(m.eta, 1.0));
}

/// Multiple scattering by facets of glass, as seen from wo.
struct GlassMultiple {
  float lost;        // by one scattering of light from wo
  float meanInFront; // mean of such losses over wo, and of those of light from behind
  float meanBehind;
  float transmitted; // share of the lost light that leaves to the other side
};

/// What the lobes do with light from wo; all that does not depend on wi.
struct BaseShares {
  vec2 albedo; // (A, B) of the facets
  float lost;  // by one reflection of all light
  float meanLost;
  vec3 multiple;      // reflectance of multiple scattering by opaque facets
  float coatMultiple; // the same of the coat alone
  vec3 coat;          // what the coat lets through to the diffuse lobe
  vec3 meanCoat;      // mean over directions
  GlassMultiple glass;
  float facetProbability;  // of choosing a facet in drawBase,
  float behindProbability; // of choosing the cosine lobe of the other side; the rest: this side's
};

// Share of the normal reflectance that KHR_materials_specular leaves.
float specularScale(const MetallicRoughness m) {
  const float amplitude = (m.eta - 1.0) / (m.eta + 1.0);
  const float normal = amplitude * amplitude;
  return normal > 0.0 ? min(largest(m.glassF0) / normal, 1.0) : 1.0;
}

// The shares of both sides must be reciprocal, (1 - transmitted) of each times its mean loss and squared index being
// equal, which leaves one factor free: the denser mean of them gets what the mean Fresnel reflectance from outside lets
// through. Its fit for indices in [1, 3] is Kulla and Conty's, slide 20.
GlassMultiple glassMultiple(const SceneRef scene, const MetallicRoughness m, const float muO, const BaseShares shares) {
  const float index = max(m.eta, 1.0 / m.eta);
  const float scale = specularScale(m);
  const float entering = 1.0 - scale * min((index - 1.0) / (4.08567 + 1.00071 * index), 1.0);
  if (m.thinWalled) return GlassMultiple(shares.lost, shares.meanLost, shares.meanLost, entering);
  if (kMultipleScattering == 0u || m.lossInFront == kInvalidIndex || transmitsDelta(m)) {
    return GlassMultiple(0.0, 1.0, 1.0, entering);
  }
  const float inFront = max(glassMeanLoss(scene, m.lossInFront, m.alpha, scale), 1e-6);
  const float behind = max(glassMeanLoss(scene, m.lossBehind, m.alpha, scale), 1e-6);
  const float denser = m.eta * m.eta * behind;
  return GlassMultiple(glassLoss(scene, m.lossInFront, muO, m.alpha, scale), inFront, behind,
                       entering * denser / max(denser, inFront));
}

// How the losses of glass continue at wi, on wo's side or the other.
float glassLossAt(const SceneRef scene, const MetallicRoughness m, const vec3 wi, const bool behind) {
  if (m.thinWalled) return lostBetweenFacets(facetAlbedo(scene, m, wi));
  if (kMultipleScattering == 0u || m.lossInFront == kInvalidIndex || transmitsDelta(m)) return 0.0;
  return glassLoss(scene, behind ? m.lossBehind : m.lossInFront, abs(wi.z), m.alpha, specularScale(m));
}

BaseShares baseShares(const SceneRef scene, const MetallicRoughness m, const vec3 woLocal) {
  const float muO = woLocal.z;
  const vec2 mean = facetMeanAlbedo(scene, m);
  BaseShares shares;
  shares.albedo = facetAlbedo(scene, m, woLocal);
  shares.lost = lostBetweenFacets(shares.albedo);
  shares.meanLost = max(lostBetweenFacets(mean), 1e-6);
  const float kept = 1.0 - shares.meanLost;
  shares.multiple = m.metallic * multipleReflectance(metalReflectance(m, 1.0), vec3(1.0), kept) +
                    m.diffuse * multipleReflectance(m.glassF0, vec3(m.glassF90), kept);
  shares.coatMultiple = multipleReflectance(vec3(m.dielectricF0), vec3(m.dielectricF90), kept).x;
  shares.coat = coatTransmissionAt(scene, m, muO, shares.albedo, shares.coatMultiple, shares.lost);
  const vec3 meanReflected = coatMeanReflected(scene, m, mean) + shares.coatMultiple * lostBetweenFacets(mean);
  shares.meanCoat = max(1.0 - meanReflected, vec3(kMinCoatTransmission));
  shares.glass = GlassMultiple(0.0, 1.0, 1.0, 0.0);

  float facets = luminance(m.f0 * shares.albedo.x + m.f90 * shares.albedo.y);
  const float coat = shares.coat.y; // under a film green stands for all channels
  const float below = luminance(m.baseColor) * coat;
  float above = m.diffuse * (1.0 - crossingShare(m.behind)) * below + luminance(shares.multiple) * shares.lost;
  float behind = 0.0;
  if (kHasDiffuseTransmission) {
    behind = m.diffuse * crossingShare(m.behind) * (luminance(m.behind.color) * coat);
  }
  if (kHasTransmission && m.glass > 0.0) {
    shares.glass = glassMultiple(scene, m, muO, shares);
    facets += m.glass * (luminance(m.glassF0 * shares.albedo.x + m.dielectricF90 * shares.albedo.y) + below);
    above += m.glass * (1.0 - shares.glass.transmitted) * shares.glass.lost;
    behind += m.glass * luminance(m.baseColor) * shares.glass.transmitted * shares.glass.lost;
  }
  const float sum = facets + above + behind;
  shares.facetProbability = facets > 0.0 ? facets / sum : 0.0;
  shares.behindProbability = behind > 0.0 ? behind / sum : 0.0;
  return shares;
}

#endif
