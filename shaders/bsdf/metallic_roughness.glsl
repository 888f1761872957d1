// The base of a surface: the glTF 2.0 metallic-roughness model with transmission, made energy conserving and
// reciprocal. Formulas: docs/bsdf.md.
//
// Directions are unit and in the local shading frame, z the shading normal on wo's side; wi.z < 0: transmitted.
#ifndef ISOPHOTE_BSDF_METALLIC_ROUGHNESS_GLSL
#define ISOPHOTE_BSDF_METALLIC_ROUGHNESS_GLSL

#include "bsdf/dielectric_interface.glsl"
#include "bsdf/fresnel.glsl"
#include "bsdf/ggx.glsl"
#include "bsdf/ggx_albedo.glsl"
#include "math/constants.glsl"
#include "sampling/warp.glsl"
#include "shared/bsdf_constants.h"
#include "shared/buffers.glsl"
#include "shared/constants.glsl"

struct MetallicRoughness {
  vec3 baseColor;
  float metallic;
  vec3 f0;     // of all facets but those of glass
  float alpha; // roughness squared; below kMirrorAlpha the specular lobe is a delta mirror
  vec3 f90;
  float diffuse;      // share of the surface that has a diffuse lobe under its coat
  float dielectricF0; // of the coat over the diffuse lobe: its largest channel, so that no channel gains energy
  float dielectricF90;
  vec3 glassF0;    // at normal incidence; f90 is dielectricF90
  float glass;     // share of the surface whose facets transmit
  float eta;       // index behind the surface over the index in front; of thin walls that of the wall
  bool thinWalled; // both boundaries in one: transmission does not bend
};

/// Of the continuous lobes. f scatters radiance: across a boundary of index ratio eta it carries the factor 1 / eta^2.
struct BsdfValue {
  vec3 fCos;           // f |cos wi|
  float pdfSolidAngle; // of sampleBsdf, per steradian of wi
};

struct BsdfSample {
  vec3 wiLocal;
  vec3 weight;         // f |cos wi| / pdf over all continuous lobes; for the delta lobe reflectance / its probability
  float pdfSolidAngle; // of all continuous lobes; 0 for the delta lobe
  bool delta;
  bool valid; // false: absorbed
  float eta;  // index on wi's side over the index on wo's: 1 unless the sample is refracted
};

// A direction closer to the horizon than this counts as below it: single precision cannot tell.
const float kMinCosine = 1e-7;

/// Derives the lobes' parameters from glTF's factors after texturing.
///
/// Source: Khronos, glTF 2.0 appendix B; KHR_materials_ior; KHR_materials_specular.
/// @param ior           of the dielectric; 0 stands for infinity as in KHR_materials_ior
/// @param roughness     perceptual, in [0, 1]
/// @param specularColor linear, any positive value; the reflectance is clamped to 1
MetallicRoughness metallicRoughness(const vec3 baseColor, const float metallic, const float roughness, const float ior,
                                    const float specular, const vec3 specularColor) {
  const float amplitude = (ior - 1.0) / (ior + 1.0);
  const vec3 dielectric = min(amplitude * amplitude * specularColor, vec3(1.0)) * specular;
  MetallicRoughness m;
  m.baseColor = baseColor;
  m.metallic = metallic;
  m.alpha = roughness * roughness;
  m.f0 = mix(dielectric, baseColor, metallic);
  m.f90 = vec3(mix(specular, 1.0, metallic));
  m.diffuse = 1.0 - metallic;
  m.dielectricF0 = max(dielectric.x, max(dielectric.y, dielectric.z));
  m.dielectricF90 = specular;
  m.glassF0 = dielectric;
  m.glass = 0.0;
  m.eta = 1.0;
  m.thinWalled = true;
  return m;
}

/// Turns a share of the dielectric into glass: facets that reflect by the exact Fresnel equations and transmit the
/// rest.
///
/// Source: Khronos, KHR_materials_transmission and KHR_materials_volume.
/// @param m            as metallicRoughness returns it
/// @param transmission share, in [0, 1]; an index that stands for infinity lets nothing through
/// @param eta          relativeIor; of thin walls the wall's own index
void setTransmission(inout MetallicRoughness m, const float transmission, const float eta, const bool thinWalled) {
  m.f0 = mix((1.0 - transmission) * m.glassF0, m.baseColor, m.metallic);
  m.f90 = vec3(mix((1.0 - transmission) * m.dielectricF90, 1.0, m.metallic));
  m.diffuse = (1.0 - m.metallic) * (1.0 - transmission);
  m.glass = (1.0 - m.metallic) * transmission;
  m.eta = eta;
  m.thinWalled = thinWalled;
}

bool isMirror(const MetallicRoughness m) { return kHasMirror && m.alpha < kMirrorAlpha; }

// Table alpha: a mirror's albedo is the limit alpha = 0.
float albedoAlpha(const MetallicRoughness m) { return isMirror(m) ? 0.0 : m.alpha; }

float coatTransmission(const MetallicRoughness m, const vec2 albedo) {
  return max(1.0 - (m.dielectricF0 * albedo.x + m.dielectricF90 * albedo.y), 0.0);
}

float largest(const vec3 v) { return max(v.x, max(v.y, v.z)); }

float luminance(const vec3 color) { return dot(color, vec3(0.2126, 0.7152, 0.0722)); } // of Rec.709 primaries

/// Returns the reflectance of a facet of glass: fresnelDielectric, scaled as KHR_materials_specular scales Schlick's
/// approximation, f0 + (f90 - f0) x with x the share of the way from normal to grazing reflectance. Total internal
/// reflection is total whatever the scale.
vec3 glassReflectance(const MetallicRoughness m, const float cosine) {
  const float exact = fresnelDielectric(cosine, m.eta);
  if (exact >= 1.0) return vec3(1.0);
  const float amplitude = (m.eta - 1.0) / (m.eta + 1.0);
  const float normal = amplitude * amplitude;
  return m.glassF0 + (vec3(m.dielectricF90) - m.glassF0) * max((exact - normal) / (1.0 - normal), 0.0);
}

/// What the facets under one cosine do with light.
struct FacetScattering {
  vec3 reflected;
  vec3 transmitted;
  float reflectedShare; // of the two, by luminance: the probability of reflecting a sampled facet's light
};

/// @param cosine between wo and the facet's normal
FacetScattering scatterAtFacet(const MetallicRoughness m, const float cosine) {
  FacetScattering facet = FacetScattering(fresnelSchlick(m.f0, m.f90, cosine), vec3(0.0), 1.0);
  if (!kHasTransmission || m.glass == 0.0) return facet;
  const vec3 reflectance = glassReflectance(m, cosine);
  facet.reflected += m.glass * reflectance;
  facet.transmitted = m.glass * (1.0 - largest(reflectance)) * m.baseColor;
  const float reflected = luminance(facet.reflected);
  const float sum = reflected + luminance(facet.transmitted);
  facet.reflectedShare = sum > 0.0 ? reflected / sum : 1.0;
  return facet;
}

// Where indices are this close for the roughness, refraction spreads light less than single precision can evaluate: its
// facet is known to 1e-7 / |eta - 1|, which must be small against alpha. Such a lobe is sampled and never evaluated, as
// a delta lobe, and masks nothing: surfaces of index 1 are invisible.
const float kMinRefractionSpread = 2e-4;

bool transmitsDelta(const MetallicRoughness m) {
  return isMirror(m) || (!m.thinWalled && m.alpha * abs(m.eta - 1.0) < kMinRefractionSpread * max(m.eta, 1.0));
}

/// Returns the probability of choosing a facet rather than the diffuse lobe: its share of the albedo's luminance. It is
/// 0 only where facets are black and 1 only where the diffuse lobe is.
float facetProbability(const MetallicRoughness m, const vec2 albedo) {
  float facets = luminance(m.f0 * albedo.x + m.f90 * albedo.y);
  const float below = luminance(m.baseColor) * coatTransmission(m, albedo);
  if (kHasTransmission) facets += m.glass * (luminance(m.glassF0 * albedo.x + m.dielectricF90 * albedo.y) + below);
  return facets > 0.0 ? facets / (facets + m.diffuse * below) : 0.0;
}

BsdfValue noScattering() { return BsdfValue(vec3(0.0), 0.0); }

// The diffuse lobe and the reflection by facets. The table's albedo at wo and the choice's probability are those that
// sampleBase knows already.
BsdfValue evaluateReflection(const SceneRef scene, const MetallicRoughness m, const vec2 albedo,
                             const float probability, const vec3 woLocal, const vec3 wiLocal) {
  const float alpha = albedoAlpha(m);
  const float entering = coatTransmission(m, ggxAlbedo(scene, wiLocal.z, alpha));
  const float mean = max(coatTransmission(m, ggxMeanAlbedo(scene, alpha)), kMinCoatTransmission);
  const float coat = coatTransmission(m, albedo) * entering / mean;
  BsdfValue value;
  value.fCos = m.baseColor * (m.diffuse * coat * kInvPi * wiLocal.z);
  value.pdfSolidAngle = (1.0 - probability) * kInvPi * wiLocal.z;
  if (!isMirror(m)) {
    const vec3 sum = woLocal + wiLocal;
    const float twoCosine = length(sum); // 2 dot(wo, wm) of unit directions: the same from both sides to the last bit
    const vec3 wm = sum / twoCosine;
    const vec2 width = vec2(m.alpha);
    const float shape = ggxD(wm, width) * ggxVisibility(woLocal, wiLocal, width) * wiLocal.z;
    const FacetScattering facet = scatterAtFacet(m, 0.5 * twoCosine);
    value.fCos += facet.reflected * shape;
    value.pdfSolidAngle += probability * facet.reflectedShare * pdfVisibleReflection(woLocal, wm, width);
  }
  return value;
}

// Transmission by facets, wi.z < 0: of thin walls the reflection mirrored to the other side, else refraction.
// Source: Walter et al. 2007, eq. 21, for radiance; KHR_materials_transmission.
BsdfValue evaluateTransmission(const MetallicRoughness m, const float probability, const vec3 woLocal,
                               const vec3 wiLocal) {
  if (m.glass == 0.0 || transmitsDelta(m)) return noScattering();
  const vec2 width = vec2(m.alpha);
  const vec3 above = vec3(wiLocal.xy, -wiLocal.z);
  const float visibility = ggxVisibility(woLocal, above, width) * above.z;
  if (m.thinWalled) {
    const vec3 sum = woLocal + above;
    const float twoCosine = length(sum);
    const vec3 wm = sum / twoCosine;
    const FacetScattering facet = scatterAtFacet(m, 0.5 * twoCosine);
    return BsdfValue(facet.transmitted * (ggxD(wm, width) * visibility),
                     probability * (1.0 - facet.reflectedShare) * pdfVisibleReflection(woLocal, wm, width));
  }
  const RefractingFacet refracting = refractingFacet(woLocal, wiLocal, m.eta);
  if (!refracting.valid) return noScattering();
  const FacetScattering facet = scatterAtFacet(m, refracting.cosO);
  const float shape = 4.0 * ggxD(refracting.wm, width) * visibility * refracting.cosO * refracting.jacobian;
  const float density = pdfVisibleNormal(woLocal, refracting.wm, width) * m.eta * m.eta * refracting.jacobian;
  return BsdfValue(facet.transmitted * shape, probability * (1.0 - facet.reflectedShare) * density);
}

/// Returns f |cos wi| and the sampling density of the continuous lobes of both sides; zeros where wo is below the
/// surface.
BsdfValue evaluateBase(const SceneRef scene, const MetallicRoughness m, const vec3 woLocal, const vec3 wiLocal) {
  const bool transmitted = kHasTransmission && wiLocal.z < 0.0;
  if (min(woLocal.z, transmitted ? -wiLocal.z : wiLocal.z) < kMinCosine) return noScattering();
  if (kHasSpecular) {
    const vec2 albedo = ggxAlbedo(scene, woLocal.z, albedoAlpha(m));
    const float probability = facetProbability(m, albedo);
    if (transmitted) return evaluateTransmission(m, probability, woLocal, wiLocal);
    return evaluateReflection(scene, m, albedo, probability, woLocal, wiLocal);
  }
  const float density = kInvPi * wiLocal.z;
  return BsdfValue(m.baseColor * (m.diffuse * density), density);
}

BsdfSample absorbed() { return BsdfSample(vec3(0.0, 0.0, 1.0), vec3(0.0), 0.0, false, false, 1.0); }

BsdfSample finishSample(const vec3 wiLocal, const BsdfValue value, const float eta) {
  const vec3 weight = value.pdfSolidAngle > 0.0 ? value.fCos / value.pdfSolidAngle : vec3(0.0);
  return BsdfSample(wiLocal, weight, value.pdfSolidAngle, false, largest(weight) > 0.0, eta);
}

// The other side of a facet of normal wm, which the choices so far reach with `probability`, and transmission with
// `transmittedProbability` of that.
BsdfSample sampleTransmission(const MetallicRoughness m, const float probability, const float transmittedProbability,
                              const vec3 transmitted, const vec3 woLocal, const vec3 wm, const float cosine) {
  const float eta = m.thinWalled ? 1.0 : m.eta;
  if (transmitsDelta(m)) {
    const vec3 wi = m.thinWalled ? -woLocal : refractAbout(woLocal, wm, cosine, m.eta);
    const vec3 weight = transmitted / (probability * transmittedProbability * eta * eta);
    return BsdfSample(wi, weight, 0.0, true, wi.z < -kMinCosine && largest(weight) > 0.0, eta);
  }
  vec3 wi;
  if (m.thinWalled) {
    wi = normalize(2.0 * cosine * wm - woLocal);
    wi.z = -wi.z;
  } else {
    wi = refractAbout(woLocal, wm, cosine, m.eta);
  }
  if (wi.z > -kMinCosine) return absorbed();
  return finishSample(wi, evaluateTransmission(m, probability, woLocal, wi), eta);
}

/// Samples a direction of scattering: the diffuse lobe or a visible facet by their shares of the albedo, at the facet
/// reflection or transmission, weighed over all lobes.
///
/// @param uLobe in [0, 1), chooses the lobe
/// @param u     in [0, 1)^2
BsdfSample sampleBase(const SceneRef scene, const MetallicRoughness m, const vec3 woLocal, const float uLobe,
                      const vec2 u) {
  if (woLocal.z < kMinCosine) return absorbed();
  if (!kHasSpecular) {
    const vec3 wi = sampleCosineHemisphere(u);
    return finishSample(wi, evaluateBase(scene, m, woLocal, wi), 1.0);
  }
  const vec2 albedo = ggxAlbedo(scene, woLocal.z, albedoAlpha(m));
  const float probability = facetProbability(m, albedo);
  vec3 wi;
  if (uLobe >= probability) {
    wi = sampleCosineHemisphere(u);
  } else {
    const vec3 wm = isMirror(m) ? vec3(0.0, 0.0, 1.0) : sampleVisibleNormal(woLocal, vec2(m.alpha), u);
    const float cosine = dot(woLocal, wm);
    const FacetScattering facet = scatterAtFacet(m, cosine);
    if (kHasTransmission && uLobe >= probability * facet.reflectedShare) {
      return sampleTransmission(m, probability, 1.0 - facet.reflectedShare, facet.transmitted, woLocal, wm, cosine);
    }
    if (isMirror(m)) {
      const vec3 weight = facet.reflected / (probability * facet.reflectedShare);
      return BsdfSample(vec3(-woLocal.xy, woLocal.z), weight, 0.0, true, true, 1.0);
    }
    wi = normalize(2.0 * cosine * wm - woLocal);
  }
  if (wi.z < kMinCosine) return absorbed();
  return finishSample(wi, evaluateReflection(scene, m, albedo, probability, woLocal, wi), 1.0);
}

#endif
