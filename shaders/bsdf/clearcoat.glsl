// KHR_materials_clearcoat: a colorless dielectric layer of index 1.5. Formulas: docs/bsdf-layers.md, "Clearcoat".
#ifndef ISOPHOTE_BSDF_CLEARCOAT_GLSL
#define ISOPHOTE_BSDF_CLEARCOAT_GLSL

#include "bsdf/facet_distribution.glsl"
#include "bsdf/fresnel.glsl"
#include "bsdf/layer.glsl"
#include "math/frame.glsl"

struct Clearcoat {
  float amount;     // coverage, in [0, 1]; 0: no coat
  float roughness;  // perceptual, in [0, 1]
  vec3 normalLocal; // unit, in the base's local frame
};

bool coatIsMirror(const Clearcoat coat) { return coat.roughness * coat.roughness < kMirrorAlpha; }

float coatReflectance(const float cosine) { return fresnelSchlick(vec3(kClearcoatF0), vec3(1.0), cosine).x; }

/// Returns the coat's own frame within the base's.
Frame coatFrame(const Clearcoat coat) { return frameFromNormal(coat.normalLocal); }

/// f |cos wi| and density of the coat's lobe, without its amount; zeros for the delta mirror.
/// @param wo, wi in the coat's frame
vec2 evaluateCoat(const Clearcoat coat, const vec3 wo, const vec3 wi) {
  if (coatIsMirror(coat) || min(wo.z, wi.z) < kMinCosine) return vec2(0.0);
  const vec2 alpha = vec2(coat.roughness * coat.roughness);
  const vec3 sum = wo + wi;
  const float twoCosine = length(sum);
  const vec3 wm = sum / twoCosine;
  return vec2(coatReflectance(0.5 * twoCosine) * facetD(wm, alpha) * facetVisibility(wo, wi, alpha) * wi.z,
              pdfVisibleReflection(wo, wm, alpha));
}

/// Samples the coat's reflection of wo, both in the coat's frame. The result may lie below the horizon.
///
/// @param u     in [0, 1)^2
/// @param uSide in [0, 1)
vec3 sampleCoat(const Clearcoat coat, const vec3 wo, const vec2 u, float uSide) {
  if (coatIsMirror(coat)) return vec3(-wo.xy, wo.z);
  const vec3 wm = sampleVisibleNormal(wo, vec2(coat.roughness * coat.roughness), u, 1.0, uSide);
  return normalize(2.0 * dot(wo, wm) * wm - wo);
}

#endif
