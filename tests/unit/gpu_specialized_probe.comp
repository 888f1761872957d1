#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#include "unit/gpu_case.h"
#define PROBE_INPUT SpecializedCase
#define PROBE_OUTPUT SpecializedResult
#include "support/probe_main.glsl"

layout(constant_id = 1) const bool kWithTexture = true;
layout(constant_id = 2) const uint kNumber = 7u;
layout(constant_id = 3) const float kMeasure = 0.25;
layout(constant_id = 4) const bool kFlag = true;

layout(set = 0, binding = 0) uniform sampler2D textures[];

// Read in a function, not in main, so that the test covers constants behind calls and early returns.
float textureRed(const uint index) {
  if (!kWithTexture) return -1.0;
  return textureLod(textures[nonuniformEXT(index)], vec2(0.5), 0.0).x;
}

SpecializedResult probe(const SpecializedCase c) {
  const float x = float(c.index);
  const float rounded = (x + kMeasure) - x; // stays an addition and a subtraction
  return SpecializedResult(rounded, gl_WorkGroupSize.x, kNumber, kMeasure, uint(kFlag), textureRed(c.index));
}
