// The base of a surface: the glTF 2.0 metallic-roughness model, made energy conserving and reciprocal. Formulas:
// docs/bsdf.md.
//
// Directions are unit and in the local shading frame, z the shading normal on wo's side.
#ifndef ISOPHOTE_BSDF_METALLIC_ROUGHNESS_GLSL
#define ISOPHOTE_BSDF_METALLIC_ROUGHNESS_GLSL

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
  vec3 f0;
  float alpha; // roughness squared; below kMirrorAlpha the specular lobe is a delta mirror
  vec3 f90;
  float dielectricF0; // of the coat over the diffuse lobe: its largest channel, so that no channel gains energy
  float dielectricF90;
};

/// Of the continuous lobes.
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
  m.dielectricF0 = max(dielectric.x, max(dielectric.y, dielectric.z));
  m.dielectricF90 = specular;
  return m;
}

bool isMirror(const MetallicRoughness m) { return kHasMirror && m.alpha < kMirrorAlpha; }

// Table alpha: a mirror's albedo is the limit alpha = 0.
float albedoAlpha(const MetallicRoughness m) { return isMirror(m) ? 0.0 : m.alpha; }

float coatTransmission(const MetallicRoughness m, const vec2 albedo) {
  return max(1.0 - (m.dielectricF0 * albedo.x + m.dielectricF90 * albedo.y), 0.0);
}

/// Returns the probability of choosing the specular lobe: its share of the albedo's luminance. It is 0 only where the
/// specular lobe is black and 1 only where the diffuse lobe is.
float specularProbability(const MetallicRoughness m, const vec2 albedo) {
  const vec3 weights = vec3(0.2126, 0.7152, 0.0722); // of Rec.709 primaries in luminance
  const float specular = dot(m.f0 * albedo.x + m.f90 * albedo.y, weights);
  const float diffuse = dot(m.baseColor, weights) * (1.0 - m.metallic) * coatTransmission(m, albedo);
  return specular > 0.0 ? specular / (specular + diffuse) : 0.0;
}

// Given the table's albedo at wo and the lobe's probability, which sampleBase knows already.
BsdfValue evaluateLobes(const SceneRef scene, const MetallicRoughness m, const vec2 albedo, const float probability,
                        const vec3 woLocal, const vec3 wiLocal) {
  const float alpha = albedoAlpha(m);
  const float entering = coatTransmission(m, ggxAlbedo(scene, wiLocal.z, alpha));
  const float mean = max(coatTransmission(m, ggxMeanAlbedo(scene, alpha)), kMinCoatTransmission);
  const float coat = coatTransmission(m, albedo) * entering / mean;
  BsdfValue value;
  value.fCos = m.baseColor * ((1.0 - m.metallic) * coat * kInvPi * wiLocal.z);
  value.pdfSolidAngle = (1.0 - probability) * kInvPi * wiLocal.z;
  if (!isMirror(m)) {
    const vec3 sum = woLocal + wiLocal;
    const float twoCosine = length(sum); // 2 dot(wo, wm) of unit directions: the same from both sides to the last bit
    const vec3 wm = sum / twoCosine;
    const vec2 width = vec2(m.alpha);
    const float shape = ggxD(wm, width) * ggxVisibility(woLocal, wiLocal, width) * wiLocal.z;
    value.fCos += fresnelSchlick(m.f0, m.f90, 0.5 * twoCosine) * shape;
    value.pdfSolidAngle += probability * pdfVisibleReflection(woLocal, wm, width);
  }
  return value;
}

/// Returns f |cos wi| and the sampling density of the continuous lobes; zeros unless both directions lie above the
/// surface.
BsdfValue evaluateBase(const SceneRef scene, const MetallicRoughness m, const vec3 woLocal, const vec3 wiLocal) {
  if (min(woLocal.z, wiLocal.z) < kMinCosine) return BsdfValue(vec3(0.0), 0.0);
  if (kHasSpecular) {
    const vec2 albedo = ggxAlbedo(scene, woLocal.z, albedoAlpha(m));
    return evaluateLobes(scene, m, albedo, specularProbability(m, albedo), woLocal, wiLocal);
  }
  const float density = kInvPi * wiLocal.z;
  return BsdfValue(m.baseColor * ((1.0 - m.metallic) * density), density);
}

BsdfSample finishSample(const vec3 wiLocal, const BsdfValue value) {
  const vec3 weight = value.pdfSolidAngle > 0.0 ? value.fCos / value.pdfSolidAngle : vec3(0.0);
  const bool valid = max(weight.x, max(weight.y, weight.z)) > 0.0;
  return BsdfSample(wiLocal, weight, value.pdfSolidAngle, false, valid);
}

/// Samples a direction of scattering: one lobe by its share of the albedo, a direction within it, weighed over all
/// lobes.
///
/// @param uLobe in [0, 1), chooses the lobe
/// @param u     in [0, 1)^2
BsdfSample sampleBase(const SceneRef scene, const MetallicRoughness m, const vec3 woLocal, const float uLobe,
                      const vec2 u) {
  const BsdfSample absorbed = BsdfSample(vec3(0.0, 0.0, 1.0), vec3(0.0), 0.0, false, false);
  if (woLocal.z < kMinCosine) return absorbed;
  if (!kHasSpecular) {
    const vec3 wi = sampleCosineHemisphere(u);
    return finishSample(wi, evaluateBase(scene, m, woLocal, wi));
  }
  const vec2 albedo = ggxAlbedo(scene, woLocal.z, albedoAlpha(m));
  const float probability = specularProbability(m, albedo);
  vec3 wi;
  if (uLobe >= probability) {
    wi = sampleCosineHemisphere(u);
  } else if (isMirror(m)) {
    const vec3 weight = fresnelSchlick(m.f0, m.f90, woLocal.z) / probability;
    return BsdfSample(vec3(-woLocal.xy, woLocal.z), weight, 0.0, true, true);
  } else {
    const vec3 wm = sampleVisibleNormal(woLocal, vec2(m.alpha), u);
    wi = normalize(2.0 * dot(woLocal, wm) * wm - woLocal);
  }
  if (wi.z < kMinCosine) return absorbed;
  return finishSample(wi, evaluateLobes(scene, m, albedo, probability, woLocal, wi));
}

#endif
