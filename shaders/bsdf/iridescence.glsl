// KHR_materials_iridescence: interference in a thin film on a microfacet. Formulas: docs/bsdf-layers.md, "Iridescence".
#ifndef ISOPHOTE_BSDF_IRIDESCENCE_GLSL
#define ISOPHOTE_BSDF_IRIDESCENCE_GLSL

#include "bsdf/fresnel.glsl"
#include "math/constants.glsl"
#include "math/trigonometry.glsl"

struct Iridescence {
  float amount;    // in [0, 1]; 0: no film
  float ior;       // of the film, at least 1
  float thickness; // nm
};

// cos(pi x) for any x whose turns single precision still tells apart.
float cosHalfTurns(const float x) { return sinCosPi(x - 2.0 * round(0.5 * x)).y; }

/// Response of the XYZ observer, in linear Rec.709, to interference at an optical path difference.
///
/// Source: Belcour and Barla 2017, "A Practical Extension to Microfacet Theory for the Modeling of Varying
/// Iridescence", section 4.2: Gaussians fitted to the color matching functions, here their Fourier transforms.
/// @param opd   nm
/// @param shift of phase, in half turns
vec3 filmSensitivity(const float opd, const vec3 shift) {
  const float phase = kTwoPi * opd * 1e-9;
  const vec3 position = 2e-9 * opd * vec3(1.6810e+06, 1.7953e+06, 2.2084e+06); // half turns
  const vec3 variance = vec3(4.3278e+09, 9.3046e+09, 6.6121e+09);
  const vec3 cosines =
      vec3(cosHalfTurns(position.x + shift.x), cosHalfTurns(position.y + shift.y), cosHalfTurns(position.z + shift.z));
  vec3 xyz =
      vec3(5.4856e-13, 4.4201e-13, 5.2481e-13) * sqrt(kTwoPi * variance) * cosines * exp(-phase * phase * variance);
  xyz.x += 9.7470e-14 * sqrt(kTwoPi * 4.5282e+09) * cosHalfTurns(2e-9 * opd * 2.2399e+06 + shift.x) *
           exp(-4.5282e+09 * phase * phase); // red has a second lobe
  const mat3 rec709FromXyz =
      mat3(3.2404542, -0.9692660, 0.0556434, -1.5371385, 1.8760108, -0.2040259, -0.4985314, 0.0415560, 1.0572252);
  return rec709FromXyz * (xyz / 1.0685e-7);
}

// Schlick's normal reflectance between two indices, and the index behind a boundary that reflects f0 towards index 1.
vec3 normalReflectance(const vec3 behind, const float front) {
  const vec3 amplitude = (behind - front) / (behind + front);
  return amplitude * amplitude;
}

vec3 indexOfReflectance(const vec3 f0) {
  const vec3 amplitude = sqrt(clamp(f0, 0.0, 0.9999));
  return (1.0 + amplitude) / (1.0 - amplitude);
}

/// Reflectance of a surface of normal reflectance f0 under the film.
///
/// Source: Belcour and Barla 2017, eq. 6 to 10, two orders of interference, with the approximations of
/// KHR_materials_iridescence: Schlick's reflectances at both boundaries, real indices. Cut to [0, 1], which the fitted
/// sensitivities leave where colors are outside Rec.709.
/// @param cosine at the outer boundary, in [0, 1]
vec3 filmReflectance(const Iridescence film, const float cosine, const vec3 f0) {
  const float ior = mix(1.0, film.ior, smoothstep(0.0, 0.03, film.thickness)); // no film, no boundary
  const float cos2Inside = 1.0 - (1.0 - cosine * cosine) / (ior * ior);        // >= 0: ior >= 1
  const float cosineInside = sqrt(max(cos2Inside, 0.0));
  const float outer = fresnelSchlick(normalReflectance(vec3(ior), 1.0), vec3(1.0), cosine).x;
  const vec3 below = indexOfReflectance(f0);
  const vec3 inner = fresnelSchlick(normalReflectance(below, ior), vec3(1.0), cosineInside);
  // Half a turn is lost where light in the film meets the lower index: outside always, below where it is lower.
  const vec3 shift = vec3(1.0) + vec3(lessThan(below, vec3(ior)));
  const float through = 1.0 - outer;
  const vec3 roundTrip = clamp(outer * inner, 1e-5, 0.9999);
  const vec3 returned = through * through * inner / (1.0 - roundTrip);
  const float opd = 2.0 * ior * film.thickness * cosineInside;
  vec3 sum = outer + returned;
  vec3 order = returned - through;
  for (int m = 1; m <= 2; ++m) {
    order *= sqrt(roundTrip);
    sum += order * 2.0 * filmSensitivity(float(m) * opd, float(m) * shift);
  }
  return clamp(sum, 0.0, 1.0);
}

/// The smallest f0 of a Schlick reflectance (f0, 1) that covers the film's brightest channel at eight cosines.
float filmBound(const Iridescence film, const vec3 f0) {
  float bound = 0.0;
  for (int i = 1; i <= 8; ++i) {
    const float t = 0.125 * float(i);
    const float cosine = t * sqrt(t); // 0.044 and on: reflectance bends most at grazing angles
    const vec3 reflectance = filmReflectance(film, cosine, f0);
    const float grazing = fresnelSchlick(vec3(0.0), vec3(1.0), cosine).x;
    const float brightest = max(reflectance.x, max(reflectance.y, reflectance.z));
    bound = max(bound, (brightest - grazing) / (1.0 - grazing));
  }
  return bound;
}

#endif
