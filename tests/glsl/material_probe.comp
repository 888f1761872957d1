#version 460
#extension GL_GOOGLE_include_directive : require
#include "bsdf/material.glsl"
#include "glsl/material_case.h"
#define PROBE_INPUT MaterialCase
#define PROBE_OUTPUT MaterialResult
#include "support/probe_main.glsl"

MaterialResult probe(const MaterialCase c) {
  SceneRef scene = SceneRef(pc.extra);
  SurfaceHit surface;
  surface.ng = c.ng;
  surface.ns = c.ns;
  surface.tangent = c.tangent;
  surface.barycentrics = c.barycentrics;
  surface.material = c.material;
  surface.geometry = 0u;
  surface.primitiveIndex = 0u;
  surface.frontFace = c.frontFace != 0u;
  const SurfaceMaterial material = materialAt(scene, surface);
  MaterialResult result;
  result.baseColor = material.baseColor;
  result.unlit = uint(material.unlit);
  result.reflectance = material.bsdf.base.baseColor;
  result.metallic = material.bsdf.base.metallic;
  result.f0 = material.bsdf.base.f0;
  result.alpha = material.bsdf.base.alpha;
  result.f90 = material.bsdf.base.f90;
  result.dielectricF0 = material.bsdf.base.dielectricF0;
  result.dielectricF90 = material.bsdf.base.dielectricF90;
  result.ns = shadingNormal(scene, surface, c.wo);
  result.coatNormal = clearcoatNormal(scene, surface, c.wo);
  result.coat = vec2(material.bsdf.coat.amount, material.bsdf.coat.roughness);
  result.sheen = vec4(material.bsdf.sheen.color, material.bsdf.sheen.roughness);
  const Iridescence film = material.bsdf.base.film;
  result.film = vec4(film.amount, film.ior, film.thickness, 0.0);
  result.glass = material.bsdf.base.glass;
  result.diffuseTransmission = vec4(material.bsdf.base.behind.color, material.bsdf.base.behind.share);
  return result;
}
