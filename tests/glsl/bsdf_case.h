#ifndef ISOPHOTE_TESTS_BSDF_CASE_H
#define ISOPHOTE_TESTS_BSDF_CASE_H

#include "shared/glsl_compat.h"

ISOPHOTE_SHARED_BEGIN

struct BsdfCase {
  vec3 baseColor;
  float metallic;
  vec3 specularColor;
  float roughness;
  float ior;
  float specular;
  float transmission; // 0: not glass
  uint backFace;      // wo is in the glass
  uint thinWalled;
  float diffuseTransmission;
  vec3 diffuseTransmissionColor;
  float anisotropy;
  uint glassLoss; // where its tables begin; set by probeBsdf
  uint exactAlbedo;
  uint anisotropicAlbedo;
  vec3 wo;
  vec3 wi;
  float uLobe;
  vec2 u;
};

ISOPHOTE_CONST uint kBsdfDelta = 1u;
ISOPHOTE_CONST uint kBsdfValid = 2u;

struct BsdfResult {
  vec3 fCos; // at the case's wi
  float pdf;
  vec3 sampledWi;
  vec3 weight;
  float sampledPdf;
  vec3 fCosSampled; // evaluated anew at sampledWi
  float pdfAtSampled;
  uint flags;
  float eta; // of the sample
};

ISOPHOTE_SHARED_END

#endif
