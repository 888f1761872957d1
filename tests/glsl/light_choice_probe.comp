#version 460
#extension GL_GOOGLE_include_directive : require
#include "glsl/light_choice_case.h"
#include "light/alias.glsl"
#define PROBE_INPUT LightChoiceCase
#define PROBE_OUTPUT LightChoiceResult
#include "support/probe_main.glsl"

LightChoiceResult probe(const LightChoiceCase c) {
  const LightChoice choice = chooseByAlias(SceneRef(pc.extra), c.bits);
  return LightChoiceResult(choice.index, choice.pmf);
}
