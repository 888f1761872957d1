// The operators of shaders/film/tone_map.glsl, in the same order with the same constants.
#include <cmath>

#include "isophote/image.hpp"

namespace isophote {
namespace {

/// Radiance beyond this is white in every operator; keeps the rational curves away from infinity over infinity.
constexpr float kLargest = 1e15f;

float usable(float value) { return std::isnan(value) ? 0.0f : std::min(std::max(value, 0.0f), kLargest); }

float encode(float linear, Transfer transfer) {
  if (transfer == Transfer::Gamma22) return std::pow(linear, 1.0f / 2.2f);
  // IEC 61966-2-1
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

glm::vec3 encode(glm::vec3 linear, Transfer transfer) {
  const glm::vec3 c = glm::clamp(linear, 0.0f, 1.0f);
  return {encode(c.r, transfer), encode(c.g, transfer), encode(c.b, transfer)};
}

/// Khronos 2024, "Khronos PBR Neutral Tone Mapper" specification, sections 2 and 3. Linear to linear.
glm::vec3 neutral(glm::vec3 color) {
  constexpr float kF90 = 0.04f; // Fresnel of ior 1.5 at normal incidence, removed from dark and middle colors
  constexpr float kStart = 0.8f - kF90;
  constexpr float kDesaturation = 0.15f;
  const float lowest = std::min(color.r, std::min(color.g, color.b));
  color -= lowest < 2 * kF90 ? lowest - lowest * lowest / (4 * kF90) : kF90;
  const float peak = std::max(color.r, std::max(color.g, color.b));
  if (peak <= kStart) return color;
  constexpr float kRoom = 1 - kStart;
  const float newPeak = 1 - kRoom * kRoom / (peak + kRoom - kStart);
  color *= newPeak / peak;
  const float white = 1 - 1 / (kDesaturation * (peak - newPeak) + 1);
  return glm::mix(color, glm::vec3(newPeak), white);
}

/// AgX by Troy Sobotka in the fit of Benjamin Wrensch 2023, "Minimal AgX Implementation" (IOLITE blog). Linear to
/// encoded.
glm::vec3 agx(glm::vec3 color) {
  const glm::mat3 inset(0.842479062253094f, 0.0423282422610123f, 0.0423756549057051f, //
                        0.0784335999999992f, 0.878468636469772f, 0.0784336f,          //
                        0.0792237451477643f, 0.0791661274605434f, 0.879142973793104f);
  const glm::mat3 outset(1.19687900512017f, -0.0528968517574562f, -0.0529716355144438f, //
                         -0.0980208811401368f, 1.15190312990417f, -0.0980434501171241f, //
                         -0.0990297440797205f, -0.0989611768448433f, 1.15107367264116f);
  constexpr float kLowestEv = -12.47393f; // log2 of 0.18, less 10 stops
  constexpr float kHighestEv = 4.026069f; // log2 of 0.18, plus 6.5 stops
  const glm::vec3 ev = glm::clamp(glm::log2(glm::max(inset * color, glm::vec3(1e-10f))), kLowestEv, kHighestEv);
  const glm::vec3 x = (ev - kLowestEv) / (kHighestEv - kLowestEv);
  const glm::vec3 x2 = x * x;
  const glm::vec3 x4 = x2 * x2;
  const glm::vec3 curve =
      15.5f * x4 * x2 - 40.14f * x4 * x + 31.96f * x4 - 6.868f * x2 * x + 0.4298f * x2 + 0.1191f * x - 0.00232f;
  return outset * curve;
}

/// Krzysztof Narkowicz 2015, "ACES Filmic Tone Mapping Curve". Linear to linear, per channel.
glm::vec3 aces(glm::vec3 x) { return (x * (2.51f * x + 0.03f)) / (x * (2.43f * x + 0.59f) + 0.14f); }

} // namespace

glm::vec3 toneMap(glm::vec3 color, ToneMap operation, Transfer transfer) {
  const glm::vec3 c(usable(color.r), usable(color.g), usable(color.b));
  switch (operation) {
  case ToneMap::Neutral:
    return encode(neutral(c), transfer);
  case ToneMap::Agx:
    return glm::clamp(agx(c), 0.0f, 1.0f);
  case ToneMap::Aces:
    return encode(aces(c), transfer);
  case ToneMap::Srgb:
    return encode(c, transfer);
  case ToneMap::Linear:
    return glm::clamp(c, 0.0f, 1.0f);
  }
  return c;
}

} // namespace isophote
