#version 460
#extension GL_GOOGLE_include_directive : require
#include "bsdf/ggx.glsl"
#include "glsl/ggx_case.h"
#define PROBE_INPUT GgxCase
#define PROBE_OUTPUT GgxResult
#include "support/probe_main.glsl"

GgxResult probe(const GgxCase c) {
  GgxResult result;
  result.d = ggxD(c.wm, c.alpha);
  result.g1 = ggxG1(c.wo, c.alpha);
  result.visibility = ggxVisibility(c.wo, c.wi, c.alpha);
  result.weight = ggxSampleWeight(c.wo, c.wi, c.alpha);
  result.pdfNormal = pdfVisibleNormal(c.wo, c.wm, c.alpha);
  result.pdfReflection = pdfVisibleReflection(c.wo, c.wm, c.alpha);
  result.sampled = sampleVisibleNormal(c.wo, c.alpha, c.u);
  result.pdfSampled = pdfVisibleNormal(c.wo, result.sampled, c.alpha);
  return result;
}
