#ifndef ISOPHOTE_TESTS_GPU_CASE_H
#define ISOPHOTE_TESTS_GPU_CASE_H

#include "shared/glsl_compat.h"

ISOPHOTE_SHARED_BEGIN

// Kernel gpu_counter: adds one to word `index` of `counters` per invocation.
struct CounterArgs {
  Address counters; // uint[]
  uint index;
  uint rounds; // additions by each invocation, one where 0
};

struct SpecializedCase {
  uint index;
};

struct SpecializedResult {
  float rounded; // (index + constant 3) - index
  uint workgroupSize;
  uint number;   // constant 2
  float measure; // constant 3
  uint flag;     // constant 4
  float red;     // of texture 0 where constant 1 is set, else -1
};

struct TextureCase {
  uint texture;
  vec2 uv;
};

struct TextureResult {
  vec4 color;
};

ISOPHOTE_SHARED_END

#endif
