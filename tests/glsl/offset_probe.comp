#version 460
#extension GL_GOOGLE_include_directive : require

#include "geometry/ray_offset.glsl"
#include "glsl/offset_case.h"
#define PROBE_INPUT OffsetCase
#define PROBE_OUTPUT OffsetResult
#include "support/probe_main.glsl"

OffsetResult probe(const OffsetCase c) { return OffsetResult(offsetRayOrigin(c.p, c.pError, c.ng, c.w)); }
