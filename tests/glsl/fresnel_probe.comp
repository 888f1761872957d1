#version 460
#extension GL_GOOGLE_include_directive : require
#include "bsdf/fresnel.glsl"
#include "glsl/fresnel_case.h"
#define PROBE_INPUT FresnelCase
#define PROBE_OUTPUT FresnelResult
#include "support/probe_main.glsl"

FresnelResult probe(const FresnelCase c) {
  return FresnelResult(fresnelDielectric(c.cosine, c.eta), fresnelSchlick(c.f0, c.f90, c.cosine));
}
