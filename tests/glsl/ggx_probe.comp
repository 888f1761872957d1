#version 460
#extension GL_GOOGLE_include_directive : require
#include "bsdf/facet_distribution.glsl"
#include "glsl/ggx_case.h"
#define PROBE_INPUT GgxCase
#define PROBE_OUTPUT GgxResult
#include "support/probe_main.glsl"

GgxResult probe(const GgxCase c) {
  GgxResult result;
  result.d = facetD(c.wm, c.alpha);
  const float g1 = 2.0 * c.wo.z / (c.wo.z + facetProjectedLength(c.wo, c.alpha));
  result.g1 = g1;
  result.visibility = facetVisibility(c.wo, c.wi, c.alpha);
  result.weight = result.visibility * c.wi.z * 2.0 * (c.wo.z + facetProjectedLength(c.wo, c.alpha));
  result.pdfNormal = pdfVisibleNormal(c.wo, c.wm, c.alpha);
  result.pdfReflection = pdfVisibleReflection(c.wo, c.wm, c.alpha);
  float uSide = c.uSide;
  result.sampled = sampleVisibleNormal(c.wo, c.alpha, c.u, 1.0, uSide);
  result.pdfSampled = pdfVisibleNormal(c.wo, result.sampled, c.alpha);
  result.sampledUnseen = sampleFacetNormal(c.alpha, c.u);
  result.projectedLength = facetProjectedLength(c.wo, c.alpha);
  return result;
}
