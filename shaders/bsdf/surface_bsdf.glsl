// The scattering of a surface: its base, and what lies over it.
//
// Directions are unit and in the local shading frame, z the shading normal on wo's side.
#ifndef ISOPHOTE_BSDF_SURFACE_BSDF_GLSL
#define ISOPHOTE_BSDF_SURFACE_BSDF_GLSL

#include "bsdf/metallic_roughness.glsl"

struct SurfaceBsdf {
  MetallicRoughness base;
};

/// Whether light passes to the other side.
bool transmits(const SurfaceBsdf bsdf) { return kHasTransmission && bsdf.base.glass > 0.0; }

/// Returns f |cos wi| and the sampling density of the continuous lobes.
BsdfValue evaluateBsdf(const SceneRef scene, const SurfaceBsdf bsdf, const vec3 woLocal, const vec3 wiLocal) {
  return evaluateBase(scene, bsdf.base, woLocal, wiLocal);
}

/// Returns f |cos wi| of the continuous lobes.
vec3 evalBsdf(const SceneRef scene, const SurfaceBsdf bsdf, const vec3 woLocal, const vec3 wiLocal) {
  return evaluateBsdf(scene, bsdf, woLocal, wiLocal).fCos;
}

/// Returns the density of sampleBsdf's continuous lobes, per steradian of wi, lobe probabilities included.
float pdfBsdf(const SceneRef scene, const SurfaceBsdf bsdf, const vec3 woLocal, const vec3 wiLocal) {
  return evaluateBsdf(scene, bsdf, woLocal, wiLocal).pdfSolidAngle;
}

/// Samples a direction of scattering, weighed over all lobes.
///
/// @param uLobe in [0, 1), chooses the lobe
/// @param u     in [0, 1)^2
BsdfSample sampleBsdf(const SceneRef scene, const SurfaceBsdf bsdf, const vec3 woLocal, const float uLobe,
                      const vec2 u) {
  return sampleBase(scene, bsdf.base, woLocal, uLobe, u);
}

#endif
