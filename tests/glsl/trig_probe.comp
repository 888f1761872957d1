#version 460
#extension GL_GOOGLE_include_directive : require
#include "glsl/trig_case.h"
#include "math/constants.glsl"
#include "math/trigonometry.glsl"
#define PROBE_INPUT TrigCase
#define PROBE_OUTPUT TrigResult
#include "support/probe_main.glsl"

TrigResult probe(const TrigCase c) {
  TrigResult result;
  result.sinCosPi = sinCosPi(c.x);
  result.builtInSinCos = vec2(sin(kPi * c.x), cos(kPi * c.x));
  result.atan2Pi = atan2Pi(c.y, c.x);
  result.builtInAtan2 = atan(c.y, c.x) * kInvPi;
  return result;
}
