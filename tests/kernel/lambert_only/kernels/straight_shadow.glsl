// Of the control: there is no glass that shadow rays could cross. Found before the product's file of this name when the
// control is compiled.
#ifndef ISOPHOTE_KERNELS_STRAIGHT_SHADOW_GLSL
#define ISOPHOTE_KERNELS_STRAIGHT_SHADOW_GLSL

#include "bsdf/surface_bsdf.glsl"
#include "kernels/mis.glsl"

void keepLightWeight(const uint slot, const float weight) {}
void followGlass(const uint slot, const bool glass, const BsdfSample bsdf) {}
bool isCountedBehindGlass(const uint slot) { return false; }
float foundWeight(const uint slot, const float pdfBsdf, const float pdfLight) {
  return emissionWeight(pdfBsdf, pdfLight);
}

#endif
