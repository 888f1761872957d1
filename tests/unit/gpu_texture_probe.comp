#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#include "unit/gpu_case.h"
#define PROBE_INPUT TextureCase
#define PROBE_OUTPUT TextureResult
#include "support/probe_main.glsl"

layout(set = 0, binding = 0) uniform sampler2D textures[];

TextureResult probe(const TextureCase c) {
  return TextureResult(textureLod(textures[nonuniformEXT(c.texture)], c.uv, 0.0));
}
