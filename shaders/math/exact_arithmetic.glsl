// Error-free transformations: what single precision loses, kept in a second float. `precise` forbids the compiler to
// contract or to reassociate, which would destroy the identities. No fma: Vulkan allows an unfused one.
//
// Sources: Dekker 1971, "A Floating-Point Technique for Extending the Available Precision", sections 4 and 5;
// Knuth 1997, "The Art of Computer Programming" vol. 2, 4.2.2, theorem B.
#ifndef ISOPHOTE_MATH_EXACT_ARITHMETIC_GLSL
#define ISOPHOTE_MATH_EXACT_ARITHMETIC_GLSL

/// Returns (s, e) with s = fl(a + b) and s + e = a + b exactly, short of overflow.
vec2 twoSum(const float a, const float b) {
  precise const float sum = a + b;
  precise const float bRounded = sum - a;
  precise const float aRounded = sum - bRounded;
  precise const float bError = b - bRounded;
  precise const float aError = a - aRounded;
  precise const float error = aError + bError;
  return vec2(sum, error);
}

/// Splits `a` into a high part of 12 and a low part of 11 bits and sign: a = x + y. |a| < 2^115.
vec2 splitFloat(const float a) {
  precise const float scaled = 4097.0 * a; // 2^12 + 1
  precise const float excess = scaled - a;
  precise const float high = scaled - excess;
  precise const float low = a - high;
  return vec2(high, low);
}

/// Returns (p, e) with p = fl(a b) and p + e = a b exactly, for |a|, |b| < 2^115 and a b in [2^-102, 2^127] or 0.
vec2 twoProduct(const float a, const float b) {
  precise const float product = a * b;
  const vec2 as = splitFloat(a);
  const vec2 bs = splitFloat(b);
  precise const float remainder1 = product - as.x * bs.x;
  precise const float remainder2 = remainder1 - as.y * bs.x;
  precise const float remainder3 = remainder2 - as.x * bs.y;
  precise const float error = as.y * bs.y - remainder3;
  return vec2(product, error);
}

/// Returns a b - c d within 2 ulp also where the products nearly cancel (tests/glsl/precision_test.cpp). Domain: that
/// of twoProduct for both products.
float differenceOfProducts(const float a, const float b, const float c, const float d) {
  const vec2 ab = twoProduct(a, b);
  const vec2 cd = twoProduct(c, d);
  const vec2 difference = twoSum(ab.x, -cd.x);
  precise const float errors = ab.y - cd.y;
  precise const float low = difference.y + errors;
  precise const float result = difference.x + low;
  return result;
}

#endif
