#ifndef ISOPHOTE_TESTS_LIGHT_ENVIRONMENT_CASE_H
#define ISOPHOTE_TESTS_LIGHT_ENVIRONMENT_CASE_H

#include "shared/glsl_compat.h"

ISOPHOTE_SHARED_BEGIN

struct LightEnvironmentCase {
  vec3 direction; // looked up
  vec2 u;         // sampled
};

struct LightEnvironmentResult {
  vec3 radiance; // at the case's direction
  float pdf;
  vec3 direction; // of the sample
  float samplePdf;
  vec3 sampleRadiance;
  float pdfAtSample; // environmentPdfSolidAngle of the sampled direction
  vec3 radianceAtSample;
};

ISOPHOTE_SHARED_END

#endif
