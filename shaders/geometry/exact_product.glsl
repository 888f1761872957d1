// Differences of products without cancellation, from plain float operations (fma may be unfused in Vulkan).
#ifndef ISOPHOTE_GEOMETRY_EXACT_PRODUCT_GLSL
#define ISOPHOTE_GEOMETRY_EXACT_PRODUCT_GLSL

// `precise` throughout: re-association would turn every one of these errors into 0.

/// The rounding error of product = a * b, exact where |a|, |b| and the product lie within [2^-60, 2^60] or are 0.
///
/// Source: Dekker 1971, "A floating-point technique for extending the available precision", with Veltkamp's splitting.
float productError(const float a, const float b, const float product) {
  precise float sa = 4097.0 * a;
  precise float ah = sa - (sa - a);
  precise float al = a - ah;
  precise float sb = 4097.0 * b;
  precise float bh = sb - (sb - b);
  precise float bl = b - bh;
  precise float error = ((ah * bh - product) + ah * bl + al * bh) + al * bl;
  return error;
}

/// a * b - c * d to 2 ulp, same range as productError. Never of the wrong sign: rounding is monotonic, and where the
/// rounded products are equal the difference of their errors decides.
float differenceOfProducts(const float a, const float b, const float c, const float d) {
  precise float ab = a * b;
  precise float cd = c * d;
  precise float error = productError(a, b, ab) - productError(c, d, cd);
  precise float difference = (ab - cd) + error;
  return difference;
}

vec3 exactCross(const vec3 a, const vec3 b) {
  return vec3(differenceOfProducts(a.y, b.z, a.z, b.y), differenceOfProducts(a.z, b.x, a.x, b.z),
              differenceOfProducts(a.x, b.y, a.y, b.x));
}

#endif
