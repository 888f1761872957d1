#version 460
#extension GL_GOOGLE_include_directive : require
#include "glsl/precision_case.h"
#include "math/exact_arithmetic.glsl"
#define PROBE_INPUT ExactCase
#define PROBE_OUTPUT ExactResult
#include "support/probe_main.glsl"

ExactResult probe(const ExactCase c) {
  return ExactResult(twoSum(c.a, c.b), twoProduct(c.a, c.b), differenceOfProducts(c.a, c.b, c.c, c.d));
}
