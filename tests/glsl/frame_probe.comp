#version 460
#extension GL_GOOGLE_include_directive : require
#include "glsl/frame_case.h"
#include "math/frame.glsl"
#include "math/normalize.glsl"
#define PROBE_INPUT FrameCase
#define PROBE_OUTPUT FrameResult
#include "support/probe_main.glsl"

FrameResult probe(const FrameCase c) {
  const Frame frame = frameFromNormal(c.normal);
  const Frame given = frameFromNormalTangent(c.normal, c.tangent, c.handedness);
  FrameResult result;
  result.tangent = frame.tangent;
  result.bitangent = frame.bitangent;
  result.tangentGiven = given.tangent;
  result.bitangentGiven = given.bitangent;
  result.roundTrip = toWorld(frame, toLocal(frame, c.tangent));
  result.normalized = safeNormalize(c.tangent, c.normal);
  return result;
}
