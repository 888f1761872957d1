#ifndef ISOPHOTE_TESTS_LIGHT_SAMPLE_CASE_H
#define ISOPHOTE_TESTS_LIGHT_SAMPLE_CASE_H

#include "shared/glsl_compat.h"

ISOPHOTE_SHARED_BEGIN

struct LightSampleCase {
  vec3 p;
  uvec2 choiceBits;
  vec2 u;
};

struct LightSampleResult {
  vec3 point;
  vec3 pointError;
  vec3 ngLight;
  vec3 wi;
  float distance;
  vec3 radiance;
  float pdfSolidAngle;
  uint delta;
  uint atInfinity;
  uint valid;
  uint light;       // index of the chosen light
  float hitPdf;     // what a ray along wi that finds the light is told
  vec3 hitRadiance; // and sees
};

ISOPHOTE_SHARED_END

#endif
