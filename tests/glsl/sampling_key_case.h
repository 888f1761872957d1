#ifndef ISOPHOTE_TESTS_SAMPLING_KEY_CASE_H
#define ISOPHOTE_TESTS_SAMPLING_KEY_CASE_H

#include "shared/glsl_compat.h"

ISOPHOTE_SHARED_BEGIN

struct SamplingKeyCase {
  uint pixel;
  uint sampleIndex;
  uvec2 seed;
  uint pair;
};

struct SamplingKeyResult {
  uvec2 bits;
  vec2 unit;
};

ISOPHOTE_SHARED_END

#endif
