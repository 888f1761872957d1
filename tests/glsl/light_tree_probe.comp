#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#include "glsl/light_tree_case.h"
#include "light/light_tree.glsl"
#define PROBE_INPUT LightTreeCase
#define PROBE_OUTPUT LightTreeResult
#include "support/probe_main.glsl"

LightTreeResult probe(const LightTreeCase c) {
  SceneRef scene = SceneRef(pc.extra);
  const LightChoice choice = chooseFromLightTree(scene, c.receiver, c.bits);
  LightTreeResult result;
  result.index = choice.index;
  result.pmf = choice.pmf;
  result.pmfOfIndex = choice.pmf > 0.0 ? lightTreePmf(scene, c.receiver, choice.index) : 0.0;
  result.pmfOfLight = lightTreePmf(scene, c.receiver, c.light);
  return result;
}
