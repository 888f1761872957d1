#version 460
#extension GL_GOOGLE_include_directive : require
#include "geometry/exact_product.glsl"
#include "glsl/precision_case.h"
#define PROBE_INPUT ExactCase
#define PROBE_OUTPUT ExactResult
#include "support/probe_main.glsl"

// Knuth 1997, "The Art of Computer Programming" vol. 2, 4.2.2, theorem B. Here to see whether the device obeys
// `precise`.
vec2 twoSum(const float a, const float b) {
  precise float sum = a + b;
  precise float bRounded = sum - a;
  precise float aRounded = sum - bRounded;
  precise float error = (a - aRounded) + (b - bRounded);
  return vec2(sum, error);
}

ExactResult probe(const ExactCase c) {
  precise float product = c.a * c.b;
  return ExactResult(twoSum(c.a, c.b), vec2(product, productError(c.a, c.b, product)),
                     differenceOfProducts(c.a, c.b, c.c, c.d));
}
