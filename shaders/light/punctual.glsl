// Point, spot and directional lights of KHR_lights_punctual.
#ifndef ISOPHOTE_LIGHT_PUNCTUAL_GLSL
#define ISOPHOTE_LIGHT_PUNCTUAL_GLSL

#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require // of shared/light_types.h

#include "shared/geometry_types.h"
#include "shared/light_types.h"

struct PunctualSample {
  vec3 wi;         // unit, towards the light
  float distance;  // kRayInfinity for directional lights
  vec3 irradiance; // on a surface that faces the light; 0: the light does not reach the point
};

/// The extension's falloff between the cones of a spot light, in [0, 1].
///
/// @param cosAngle  of the angle between the light's axis and the direction in which the light leaves
float spotFalloff(float cosAngle, float cosInner, float cosOuter) {
  const float falloff = clamp((cosAngle - cosOuter) / max(0.001, cosInner - cosOuter), 0.0, 1.0);
  return falloff * falloff;
}

/// The extension's recommended window that ends a light at its range. @param range  0: unlimited
float rangeWindow(float distance, float range) {
  if (range <= 0.0) return 1.0;
  const float ratio = min(distance / range, 1.0);
  const float squared = ratio * ratio;
  return 1.0 - squared * squared;
}

/// What a punctual light does at point p, unoccluded. Lights nearer than 1e-15 count as absent: their inverse square
/// would leave the range of float.
PunctualSample punctualLightAt(const PunctualLightRecord light, vec3 p) {
  if (light.kind == kLightDirectional) return PunctualSample(-light.direction, kRayInfinity, light.intensity);
  const vec3 toLight = light.position - p;
  const float distance = length(toLight);
  if (!(distance > 1e-15)) return PunctualSample(vec3(0.0, 1.0, 0.0), 0.0, vec3(0.0));
  const vec3 wi = toLight / distance;
  float attenuation = rangeWindow(distance, light.range);
  if (light.kind == kLightSpot) attenuation *= spotFalloff(-dot(wi, light.direction), light.cosInner, light.cosOuter);
  return PunctualSample(wi, distance, light.intensity * attenuation / distance / distance);
}

#endif
