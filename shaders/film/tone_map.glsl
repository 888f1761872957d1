// Scene-linear Rec.709 to display-referred color; the operators of engine/src/io/tone_map.cpp with the same constants.
#ifndef ISOPHOTE_FILM_TONE_MAP_GLSL
#define ISOPHOTE_FILM_TONE_MAP_GLSL

// Values of isophote::ToneMap.
const uint kToneMapNeutral = 0u;
const uint kToneMapAgx = 1u;
const uint kToneMapAces = 2u;
const uint kToneMapSrgb = 3u;
const uint kToneMapLinear = 4u;

// Radiance beyond this is white in every operator; keeps the rational curves away from infinity over infinity.
const float kToneMapLargest = 1e15;

float usableForDisplay(const float value) {
  const bool nan = (floatBitsToUint(value) & 0x7fffffffu) > 0x7f800000u;
  return nan ? 0.0 : clamp(value, 0.0, kToneMapLargest);
}

// IEC 61966-2-1. @param linear  in [0, 1] after clamping
vec3 encodeSrgb(const vec3 linear) {
  const vec3 c = clamp(linear, vec3(0.0), vec3(1.0));
  const vec3 high = 1.055 * pow(max(c, vec3(0.0031308)), vec3(1.0 / 2.4)) - 0.055;
  return mix(high, 12.92 * c, lessThanEqual(c, vec3(0.0031308)));
}

// Khronos 2024, "Khronos PBR Neutral Tone Mapper" specification, sections 2 and 3. Linear to linear.
vec3 toneMapNeutral(vec3 color) {
  const float f90 = 0.04; // Fresnel of ior 1.5 at normal incidence, removed from dark and middle colors
  const float start = 0.8 - f90;
  const float desaturation = 0.15;
  const float lowest = min(color.r, min(color.g, color.b));
  color -= lowest < 2.0 * f90 ? lowest - lowest * lowest / (4.0 * f90) : f90;
  const float peak = max(color.r, max(color.g, color.b));
  if (peak <= start) return color;
  const float room = 1.0 - start;
  const float newPeak = 1.0 - room * room / (peak + room - start);
  color *= newPeak / peak;
  const float white = 1.0 - 1.0 / (desaturation * (peak - newPeak) + 1.0);
  return mix(color, vec3(newPeak), white);
}

// AgX by Troy Sobotka in the fit of Benjamin Wrensch 2023, "Minimal AgX Implementation" (IOLITE blog). Linear to
// encoded.
vec3 toneMapAgx(const vec3 color) {
  const mat3 inset = mat3(0.842479062253094, 0.0423282422610123, 0.0423756549057051, //
                          0.0784335999999992, 0.878468636469772, 0.0784336,          //
                          0.0792237451477643, 0.0791661274605434, 0.879142973793104);
  const mat3 outset = mat3(1.19687900512017, -0.0528968517574562, -0.0529716355144438, //
                           -0.0980208811401368, 1.15190312990417, -0.0980434501171241, //
                           -0.0990297440797205, -0.0989611768448433, 1.15107367264116);
  const float lowestEv = -12.47393; // log2 of 0.18, less 10 stops
  const float highestEv = 4.026069; // log2 of 0.18, plus 6.5 stops
  const vec3 ev = clamp(log2(max(inset * color, vec3(1e-10))), vec3(lowestEv), vec3(highestEv));
  const vec3 x = (ev - lowestEv) / (highestEv - lowestEv);
  const vec3 x2 = x * x;
  const vec3 x4 = x2 * x2;
  const vec3 curve = 15.5 * x4 * x2 - 40.14 * x4 * x + 31.96 * x4 - 6.868 * x2 * x + 0.4298 * x2 + 0.1191 * x - 0.00232;
  return outset * curve;
}

// Krzysztof Narkowicz 2015, "ACES Filmic Tone Mapping Curve". Linear to linear, per channel.
vec3 toneMapAces(const vec3 x) { return (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14); }

// Scene-linear Rec.709, already exposed, to [0, 1]: sRGB-encoded, except for kToneMapLinear which only clamps.
// NaN counts as 0.
// @param operation  one of the kToneMap constants
// Accuracy: within 4e-5 of the C++ operator, a hundredth of an 8-bit step, measured in tests/glsl/tone_map_test.cpp.
vec3 toneMap(const vec3 color, const uint operation) {
  const vec3 c = vec3(usableForDisplay(color.r), usableForDisplay(color.g), usableForDisplay(color.b));
  if (operation == kToneMapNeutral) return encodeSrgb(toneMapNeutral(c));
  if (operation == kToneMapAgx) return clamp(toneMapAgx(c), vec3(0.0), vec3(1.0));
  if (operation == kToneMapAces) return encodeSrgb(toneMapAces(c));
  if (operation == kToneMapSrgb) return encodeSrgb(c);
  return clamp(c, vec3(0.0), vec3(1.0));
}

#endif
