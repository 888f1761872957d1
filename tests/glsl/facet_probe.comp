#version 460
#extension GL_GOOGLE_include_directive : require
#include "bsdf/fresnel.glsl"
#include "bsdf/iridescence.glsl"
#include "glsl/facet_case.h"
#define PROBE_INPUT FacetCase
#define PROBE_OUTPUT FacetResult
#include "support/probe_main.glsl"

FacetResult probe(const FacetCase c) {
  const Iridescence film = Iridescence(1.0, c.filmIor, c.thickness);
  return FacetResult(fresnelConductor(c.cosine, c.n, c.k), fresnelDielectric(c.cosine, c.n),
                     filmReflectance(film, c.cosine, c.f0), filmBound(film, c.f0));
}
