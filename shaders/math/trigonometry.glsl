// Trigonometry of known accuracy. Vulkan bounds the built-ins only by 2^-11 absolute (sin, cos inside [-pi, pi]) and
// 4096 ULP (atan): Vulkan specification, "Precision and Operation of SPIR-V Instructions".
#ifndef ISOPHOTE_MATH_TRIGONOMETRY_GLSL
#define ISOPHOTE_MATH_TRIGONOMETRY_GLSL

#include "math/constants.glsl"
#include "shared/constants.glsl"

/// Sine and cosine of pi x.
///
/// The argument is reduced exactly to [-1/4, 1/4]; the polynomials interpolate sin(pi r)/r and cos(pi r) in r^2 at the
/// Chebyshev nodes (relative error below 1e-10 before rounding).
/// @param x  in [-2, 2], half turns
/// @return   vec2 (sin(pi x), cos(pi x)); exact at multiples of 1/2
/// Accuracy: <= 4 ulp or 1e-7 absolute against double, measured in tests/glsl/trig_test.cpp.
vec2 sinCosPi(float x) {
  if (kTrigonometry == 1u) {
    const float angle = kPi * (abs(x) > 1.0 ? x - 2.0 * sign(x) : x); // beyond pi Vulkan promises nothing
    return vec2(sin(angle), cos(angle));
  }
  const float quadrant = floor(2.0 * x + 0.5);
  const float r = x - 0.5 * quadrant;
  const float z = r * r;
  const float s = r * (3.14159265 + z * (-5.16771277 + z * (2.55016265 + z * (-0.599202081 + z * 0.0810016251))));
  const float c = 1.0 + z * (-4.93480216 + z * (4.05870726 + z * (-1.33504445 + z * 0.231328785)));
  const int q = int(quadrant) & 3;
  const vec2 rotated = (q & 1) == 0 ? vec2(s, c) : vec2(c, -s); // sin, cos of r + 1/2 where odd
  return (q & 2) == 0 ? rotated : -rotated;
}

/// Angle of the point (x, y) in half turns: atan2(y, x) / pi.
///
/// The polynomial interpolates atan(t) / (pi t) in t^2 on [0, 1] at the Chebyshev nodes (relative error 1.8e-8 before
/// rounding). No trigonometric built-in is used.
/// @param y, x  finite, of magnitude below 2^126
/// @return      in [-1, 1]; 0 for the zero vector
/// Accuracy: <= 1e-6 relative against double where the larger coordinate is at least 2^-100, measured in
/// tests/glsl/trig_test.cpp.
float atan2Pi(float y, float x) {
  if (kTrigonometry == 1u) return x == 0.0 && y == 0.0 ? 0.0 : atan(y, x) * kInvPi;
  const float ax = abs(x);
  const float ay = abs(y);
  const float t = min(ax, ay) / max(max(ax, ay), 7.9e-31); // the divisor stays above 2^-100
  const float z = t * t;
  float p = -0.00500741228 + z * 0.000880535401;
  p = -0.0237359069 + z * (0.013412822 + z * p);
  p = -0.0451929942 + z * (0.0337993242 + z * p);
  p = -0.106102355 + z * (0.0636361018 + z * p);
  float angle = t * (0.318309873 + z * p);
  angle = ay > ax ? 0.5 - angle : angle;
  angle = x < 0.0 ? 1.0 - angle : angle;
  return y < 0.0 ? -angle : angle;
}

#endif
