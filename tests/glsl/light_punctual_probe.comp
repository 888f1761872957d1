#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#include "glsl/light_punctual_case.h"
#include "light/punctual.glsl"
#define PROBE_INPUT LightPunctualCase
#define PROBE_OUTPUT LightPunctualResult
#include "support/probe_main.glsl"

LightPunctualResult probe(const LightPunctualCase c) {
  const PunctualSample s = punctualLightAt(c.light, c.p);
  return LightPunctualResult(s.wi, s.distance, s.irradiance);
}
