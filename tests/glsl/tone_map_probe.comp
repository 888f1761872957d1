#version 460
#extension GL_GOOGLE_include_directive : require
#include "film/tone_map.glsl"
#include "glsl/tone_map_case.h"
#define PROBE_INPUT ToneMapCase
#define PROBE_OUTPUT ToneMapResult
#include "support/probe_main.glsl"

ToneMapResult probe(const ToneMapCase c) { return ToneMapResult(toneMap(c.color, c.operation)); }
