#ifndef ISOPHOTE_TESTS_TRIG_CASE_H
#define ISOPHOTE_TESTS_TRIG_CASE_H

#include "shared/glsl_compat.h"

ISOPHOTE_SHARED_BEGIN

struct TrigCase {
  float y;
  float x; // sinCosPi takes x
};

struct TrigResult {
  vec2 sinCosPi;
  vec2 builtInSinCos; // of pi x
  float atan2Pi;
  float builtInAtan2; // in half turns
};

ISOPHOTE_SHARED_END

#endif
