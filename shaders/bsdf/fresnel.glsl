// Reflectance at a smooth boundary.
#ifndef ISOPHOTE_BSDF_FRESNEL_GLSL
#define ISOPHOTE_BSDF_FRESNEL_GLSL

// Values of isophote::Fresnel beside 0, as glTF has it.
const uint kFresnelExact = 1u;
const uint kFresnelSchlick = 2u;

/// Interpolates from f0 at normal incidence to f90 at grazing: f0 + (f90 - f0) (1 - cosine)^5.
///
/// Source: Schlick 1994, "An Inexpensive BRDF Model for Physically-based Rendering", eq. 15; f90 free as in glTF 2.0.
/// @param cosine between direction and (micro)normal; clamped to [0, 1]
/// Accuracy: 1e-6 absolute for f0, f90 in [0, 1]; measured in tests/glsl/fresnel_test.cpp.
vec3 fresnelSchlick(const vec3 f0, const vec3 f90, const float cosine) {
  const float x = 1.0 - clamp(cosine, 0.0, 1.0);
  const float x2 = x * x;
  return f0 + (f90 - f0) * (x2 * x2 * x);
}

/// Reflectance of unpolarized light at the boundary between two dielectrics.
///
/// Source: Cook and Torrance 1982, "A Reflectance Model for Computer Graphics", appendix, with
/// g - c = (eta^2 - 1) / (g + c), which does not cancel for eta near 1.
/// @param cosI on the incident side, in [0, 1]
/// @param eta  index behind the boundary over the index in front, in [2^-10, 2^10]
/// @return     in [0, 1]; exactly 1 for total internal reflection, exactly 0 for eta = 1
/// Accuracy: 1e-6 absolute for eta in [1/3, 3]; 5e-7 / (eta^2 g) more where g = sqrt(eta^2 - 1 + cosI^2) < 0.1, since
/// the reflectance leaves 1 with infinite slope there; measured in tests/glsl/fresnel_test.cpp.
float fresnelDielectric(const float cosI, const float eta) {
  if (eta == 1.0) return 0.0;                       // no boundary; the formula is 0 / 0 at cosI = 0
  const float contrast = (eta - 1.0) * (eta + 1.0); // eta^2 - 1
  const float g2 = contrast + cosI * cosI;
  if (g2 <= 0.0) return 1.0;
  const float sum = sqrt(g2) + cosI; // > 0
  const float difference = contrast / sum;
  const float s = difference / sum;
  const float p = (cosI * sum - 1.0) / (cosI * difference + 1.0); // divisor >= min(1, eta^2)
  return min(0.5 * s * s * (1.0 + p * p), 1.0);
}

/// Schlick's approximation of fresnelDielectric, by the cosine on the less dense side: 1 where reflection is total.
/// @param cosI, eta as there
float schlickDielectric(const float cosI, const float eta) {
  const float g2 = (eta - 1.0) * (eta + 1.0) + cosI * cosI; // (eta cosT)^2
  if (g2 <= 0.0) return 1.0;
  const float amplitude = (eta - 1.0) / (eta + 1.0);
  const float x = 1.0 - min(eta < 1.0 ? sqrt(g2) / eta : cosI, 1.0);
  const float x2 = x * x;
  return mix(amplitude * amplitude, 1.0, x2 * x2 * x);
}

/// How far a reflectance at the boundary of index ratio eta has come from normal to grazing incidence: at most 1. Below
/// 0 on the way there where the index is above 3.7, as the reflectance of polarized light parallel to the plane of
/// incidence falls by more than the other rises.
float grazingShare(const float reflectance, const float eta) {
  const float amplitude = (eta - 1.0) / (eta + 1.0);
  const float normal = amplitude * amplitude;
  return (reflectance - normal) / (1.0 - normal);
}

/// Reflectance of unpolarized light at the boundary between a dielectric and a conductor.
///
/// Source: Born and Wolf 1999, "Principles of Optics", section 14.2, eq. 19 to 22, with a = n cos and b = k cos of the
/// complex angle inside eliminated.
/// @param cosI on the incident side, in [0, 1]
/// @param n, k complex index n + ik over the index in front, n in [1e-3, 1e3], k in [0, 1e3]
/// @return     in [0, 1]; exactly 1 at cosI = 0
/// Accuracy: 2e-6 absolute; equal to fresnelDielectric where k = 0; measured in tests/glsl/conductor_test.cpp.
float fresnelConductor(const float cosI, const float n, const float k) {
  const float cos2 = cosI * cosI;
  const float sin2 = 1.0 - cos2;
  const float difference = (n - 1.0) * (n + 1.0) - k * k + cos2; // a^2 - b^2
  const float product = 2.0 * n * k;                             // 2 a b
  const float sum = length(vec2(difference, product));           // a^2 + b^2
  // Whichever form of a is no difference of near equals; a = 0 where both are.
  const float a = difference >= 0.0 ? sqrt(0.5 * (sum + difference)) : product * inversesqrt(2.0 * (sum - difference));
  const float twoACos = 2.0 * a * cosI;
  const float s = (sum + cos2 - twoACos) / (sum + cos2 + twoACos);
  const float p = (cos2 * sum + sin2 * sin2 - twoACos * sin2) / (cos2 * sum + sin2 * sin2 + twoACos * sin2);
  return clamp(0.5 * s * (1.0 + p), 0.0, 1.0);
}

#endif
