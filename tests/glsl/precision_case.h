#ifndef ISOPHOTE_TESTS_PRECISION_CASE_H
#define ISOPHOTE_TESTS_PRECISION_CASE_H

#include "shared/glsl_compat.h"

ISOPHOTE_SHARED_BEGIN

struct NonFiniteCase {
  uint bits; // of the float under test
};

struct NonFiniteResult {
  uint scalar;     // isNonFinite(x)
  uint components; // bit i: isNonFinite of a vec3 with x at i and ones elsewhere
};

struct ExactCase {
  float a;
  float b;
  float c;
  float d;
};

struct ExactResult {
  vec2 sum;         // of a and b, and its rounding error
  vec2 product;     // of a and b, and its rounding error
  float difference; // differenceOfProducts(a, b, c, d)
};

ISOPHOTE_SHARED_END

#endif
