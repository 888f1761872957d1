#ifndef ISOPHOTE_TESTS_LIGHT_CHOICE_CASE_H
#define ISOPHOTE_TESTS_LIGHT_CHOICE_CASE_H

#include "shared/glsl_compat.h"

ISOPHOTE_SHARED_BEGIN

struct LightChoiceCase {
  uvec2 bits;
};

struct LightChoiceResult {
  uint index;
  float pmf;
};

ISOPHOTE_SHARED_END

#endif
