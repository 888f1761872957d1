#version 460
#extension GL_GOOGLE_include_directive : require
#include "camera/pixel_filter.glsl"
#include "glsl/camera_filter_case.h"
#define PROBE_INPUT CameraFilterCase
#define PROBE_OUTPUT CameraFilterResult
#include "support/probe_main.glsl"

CameraFilterResult probe(const CameraFilterCase c) { return CameraFilterResult(sampleFilter(FloatRef(pc.extra), c.u)); }
