// The setting shadow-transmission=straight: shadow rays cross glass unbent, dimmed by its color, by reflection and by
// its medium. What paths would find behind glass is then left out, so that no light counts twice. docs/bsdf.md, "Shadow
// rays through glass".
#ifndef ISOPHOTE_KERNELS_STRAIGHT_SHADOW_GLSL
#define ISOPHOTE_KERNELS_STRAIGHT_SHADOW_GLSL

#include "bsdf/material.glsl"
#include "kernels/mis.glsl"
#include "kernels/wavefront.glsl"
#include "medium/medium_stack.glsl"

/// Keeps the weight in a shadow ray's contribution: behind glass no BSDF sample shares the light.
///
/// @param weight 0: glass stops the ray
void keepLightWeight(const uint slot, const float weight) {
  if (kStraightShadows) StraightRef(pc.straight).items[slot].lightWeight = weight;
}

/// After a surface has scattered the path. Glass that transmits passes on what was sampled before it; glass that
/// reflects, and mirrors, send light where no straight ray can.
void followGlass(const uint slot, const bool glass, const BsdfSample bsdf) {
  if (!kStraightShadows) return;
  StraightRef straight = StraightRef(pc.straight);
  uint path = kStraightNone;
  if (!glass && !bsdf.delta) path = kStraightSampled;
  if (glass && bsdf.wiLocal.z < 0.0 && straight.items[slot].path != kStraightNone) path = kStraightCounted;
  straight.items[slot].path = path;
}

/// Whether a shadow ray has counted what lies behind the glass that the path is at.
bool isCountedBehindGlass(const uint slot) {
  return kStraightShadows && StraightRef(pc.straight).items[slot].path != kStraightNone;
}

/// Whether one has counted the emission that the path has found; light of some size is left to paths where
/// light-sampling=bsdf.
bool isCounted(const uint slot) {
  return kStraightShadows && kLightSampling != 2u && StraightRef(pc.straight).items[slot].path == kStraightCounted;
}

/// Weight of emission that a path has found, as emissionWeight.
float foundWeight(const uint slot, const float pdfBsdf, const float pdfLight) {
  return isCounted(slot) ? 0.0 : emissionWeight(pdfBsdf, pdfLight);
}

/// The share of light that crosses a surface unbent; 0 where it does not transmit.
///
/// Both sides reflect by the angle outside the glass: a ray that goes straight into a plate leaves it as it entered.
/// @param wo  unit, where the ray comes from
vec3 straightTransmittance(const SceneRef scene, const SurfaceHit surface, const MediumCrossing crossing,
                           const vec3 wo) {
  const float ior = materialIor(MaterialRef(scene.view.materials).items[surface.material], 1u);
  if (ior < 1.0) return vec3(0.0); // it stands for infinity
  const float eta = isVolumeBoundary(scene, surface.material) ? etaAcross(scene, crossing, 1u)
                                                              : ior / mediumIor(scene, crossing.before, 1u);
  const MetallicRoughness base = materialAt(scene, surface, max(eta, 1.0 / eta), 1u).bsdf.base;
  return scatterAtFacet(base, dot(shadingNormal(scene, surface, wo), wo)).transmitted;
}

#endif
