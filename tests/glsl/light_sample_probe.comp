#version 460
#extension GL_GOOGLE_include_directive : require
#include "glsl/light_sample_case.h"
#include "light/light_sample.glsl"
#define PROBE_INPUT LightSampleCase
#define PROBE_OUTPUT LightSampleResult
#include "support/probe_main.glsl"

// The light found by a ray from p along the sampled direction instead.
void hitLight(SceneRef scene, const LightSampleCase c, inout LightSampleResult result) {
  if (result.light < scene.view.emissiveTriangleCount) {
    const EmissiveTriangle light = EmissiveTriangleRef(scene.view.emissiveTriangles).items[result.light];
    const SurfaceHit surface =
        surfaceAt(scene, light.instance, light.triangle, sampleUniformTriangle(c.u).xy, -result.wi);
    result.hitPdf = emitterPdfSolidAngle(scene, surface, abs(dot(surface.ng, result.wi)), distance(surface.p, c.p),
                                         LightReceiver(c.p, vec3(0.0)));
    result.hitRadiance = emittedRadiance(scene, surface);
  } else if (result.atInfinity != 0u && result.delta == 0u) {
    result.hitPdf = environmentHitPdf(scene, result.wi);
    result.hitRadiance = environmentRadiance(scene, result.wi);
  }
}

LightSampleResult probe(const LightSampleCase c) {
  SceneRef scene = SceneRef(pc.extra);
  const LightReceiver receiver = LightReceiver(c.p, vec3(0.0));
  const LightSample s = sampleLight(scene, receiver, c.choiceBits, c.u);
  LightSampleResult result;
  result.point = s.point;
  result.pointError = s.pointError;
  result.ngLight = s.ngLight;
  result.wi = s.wi;
  result.distance = s.distance;
  result.radiance = s.radiance;
  result.pdfSolidAngle = s.pdfSolidAngle;
  result.delta = uint(s.delta);
  result.atInfinity = uint(s.atInfinity);
  result.valid = uint(s.valid);
  result.light = scene.view.lightCount > 0u ? chooseLight(scene, receiver, c.choiceBits).index : kInvalidIndex;
  result.hitPdf = 0.0;
  result.hitRadiance = vec3(0.0);
  if (s.valid) hitLight(scene, c, result);
  return result;
}
