#version 460
#extension GL_GOOGLE_include_directive : require
#include "glsl/light_environment_case.h"
#include "light/environment.glsl"
#define PROBE_INPUT LightEnvironmentCase
#define PROBE_OUTPUT LightEnvironmentResult
#include "support/probe_main.glsl"

LightEnvironmentResult probe(const LightEnvironmentCase c) {
  SceneRef scene = SceneRef(pc.extra);
  const EnvironmentSample s = sampleEnvironment(scene, c.u);
  LightEnvironmentResult result;
  result.radiance = environmentRadiance(scene, c.direction);
  result.pdf = environmentPdfSolidAngle(scene, c.direction);
  result.direction = s.direction;
  result.samplePdf = s.pdfSolidAngle;
  result.sampleRadiance = s.radiance;
  result.pdfAtSample = environmentPdfSolidAngle(scene, s.direction);
  result.radianceAtSample = environmentRadiance(scene, s.direction);
  return result;
}
