#ifndef ISOPHOTE_TEST_TONE_MAP_CASE_H
#define ISOPHOTE_TEST_TONE_MAP_CASE_H

#include "shared/glsl_compat.h"

ISOPHOTE_SHARED_BEGIN

struct ToneMapCase {
  vec3 color;
  uint operation;
};

struct ToneMapResult {
  vec3 display;
};

ISOPHOTE_SHARED_END

#endif
