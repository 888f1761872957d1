// Of the control: there is no glass that shadow rays could cross. Found before the product's file of this name when the
// control is compiled.
#ifndef ISOPHOTE_KERNELS_STRAIGHT_SHADOW_GLSL
#define ISOPHOTE_KERNELS_STRAIGHT_SHADOW_GLSL

#include "bsdf/surface_bsdf.glsl"
#include "geometry/surface.glsl"
#include "kernels/mis.glsl"
#include "medium/medium_stack.glsl"

void keepLightWeight(const uint slot, const float weight) {}
void followGlass(const uint slot, const bool glass, const BsdfSample bsdf) {}
bool isCountedBehindGlass(const uint slot) { return false; }
float foundWeight(const uint slot, const float pdfBsdf, const float pdfLight) {
  return emissionWeight(pdfBsdf, pdfLight);
}
vec3 straightTransmittance(const SceneRef scene, const SurfaceHit surface, const MediumCrossing crossing,
                           const vec3 wo) {
  return vec3(0.0);
}

#endif
