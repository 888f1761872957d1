// Exponentials and logarithms near 1, where the built-ins are known to 2^-21 absolute alone (Vulkan specification,
// "Precision and Operation of SPIR-V Instructions").
#ifndef ISOPHOTE_MATH_EXPONENTIAL_GLSL
#define ISOPHOTE_MATH_EXPONENTIAL_GLSL

/// log(1 + x), from log((1+y)/(1-y)) = 2 (y + y^3/3 + ...) where x is small.
///
/// @param x > -1, finite
/// The series is cut below 1e-8; measured through what it serves in tests/glsl/facet_distribution_test.cpp.
float log1p(const float x) {
  if (abs(x) > 0.5) return log(1.0 + x);
  const float y = x / (2.0 + x);
  const float z = y * y; // at most 1/9
  const float tail = 0.111111111 + z * (0.0909090909 + z * (0.0769230769 + z * 0.0666666667));
  return 2.0 * y * (1.0 + z * (0.333333333 + z * (0.2 + z * (0.142857143 + z * tail))));
}

/// exp(x) - 1.
///
/// @param x at most 80
/// The series is cut below 1e-8; measured through what it serves in tests/glsl/facet_distribution_test.cpp.
float expm1(const float x) {
  if (abs(x) > 0.5) return exp(x) - 1.0;
  const float tail = 1.0 / 120.0 + x * (1.0 / 720.0 + x * (1.0 / 5040.0 + x * (1.0 / 40320.0)));
  return x * (1.0 + x * (0.5 + x * (1.0 / 6.0 + x * (1.0 / 24.0 + x * tail))));
}

#endif
