#version 460
#extension GL_GOOGLE_include_directive : require
#include "bsdf/direction_sampling.glsl"
#include "glsl/direction_sampling_case.h"
#define PROBE_INPUT DirectionCase
#define PROBE_OUTPUT DirectionResult
#include "support/probe_main.glsl"

DirectionResult probe(const DirectionCase c) {
  SceneRef scene = SceneRef(pc.extra);
  MetallicRoughness base = metallicRoughness(c.baseColor, c.metallic, c.roughness, 1.5, 1.0, vec3(1.0));
  setTransmission(base, c.glass, 1.5, false);
  const SurfaceBsdf m = bareSurface(base);
  DirectionResult result;
  const BsdfAtWo at = bsdfAtWo(scene, m, c.wo);
  const BsdfValue lobes = evaluateBsdf(scene, m, at, c.wo, c.wi);
  result.fCos = lobes.fCos;
  result.pdfLobes = lobes.pdfSolidAngle;
  result.pdf = evaluateDirection(scene, m, at, c.wo, c.wi).pdfSolidAngle;
  const BsdfSample drawn = sampleDirection(scene, m, at, c.wo, c.uLobe, c.u);
  result.sampledWi = drawn.wiLocal;
  result.weight = drawn.weight;
  result.sampledPdf = drawn.pdfSolidAngle;
  const BsdfValue again = evaluateDirection(scene, m, at, c.wo, drawn.wiLocal);
  result.fCosSampled = again.fCos;
  result.pdfAtSampled = again.pdfSolidAngle;
  result.flags = (drawn.delta ? kDirectionDelta : 0u) | (drawn.valid ? kDirectionValid : 0u);
  return result;
}
