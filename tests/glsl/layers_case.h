#ifndef ISOPHOTE_TESTS_LAYERS_CASE_H
#define ISOPHOTE_TESTS_LAYERS_CASE_H

#include "shared/glsl_compat.h"

ISOPHOTE_SHARED_BEGIN

struct LayersCase {
  vec3 baseColor;
  float metallic;
  float roughness;
  float specular;
  float coat;
  float coatRoughness;
  vec3 coatNormal;
  vec3 sheenColor;
  float sheenRoughness;
  float anisotropy;
  float film;
  float filmIor;
  float filmThickness;
  uint filmAlbedo;    // where its table begins; set by probeLayers
  float transmission; // of a thin wall
  vec3 conductorN;    // 0: none
  vec3 conductorK;
  float diffuseTransmission; // of a thin wall, white
  vec3 wo;
  vec3 wi;
  float uLobe;
  vec2 u;
};

ISOPHOTE_CONST uint kLayersDelta = 1u;
ISOPHOTE_CONST uint kLayersValid = 2u;

struct LayersResult {
  vec3 fCos; // at the case's wi
  float pdf;
  vec3 sampledWi;
  vec3 weight;
  float sampledPdf;
  vec3 fCosSampled; // evaluated anew at sampledWi
  float pdfAtSampled;
  uint flags;
};

ISOPHOTE_SHARED_END

#endif
