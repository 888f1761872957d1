#version 460
#extension GL_GOOGLE_include_directive : require
#include "bsdf/direction_sampling.glsl"
#include "glsl/layers_case.h"
#define PROBE_INPUT LayersCase
#define PROBE_OUTPUT LayersResult
#include "support/probe_main.glsl"

LayersResult probe(const LayersCase c) {
  SceneRef scene = SceneRef(pc.extra);
  SurfaceBsdf bsdf = bareSurface(metallicRoughness(c.baseColor, c.metallic, c.roughness, 1.5, c.specular, vec3(1.0)));
  setAnisotropy(bsdf.base, c.anisotropy, kInvalidIndex);
  if (c.conductorN.x > 0.0) setConductor(bsdf.base, c.conductorN, c.conductorK);
  if (c.transmission > 0.0) setTransmission(bsdf.base, c.transmission, 1.5, true);
  setIridescence(bsdf.base, Iridescence(c.film, c.filmIor, c.filmThickness), c.filmAlbedo);
  if (c.diffuseTransmission > 0.0) {
    setDiffuseTransmission(bsdf.base, DiffuseTransmission(c.diffuseTransmission, vec3(1.0), 1.0), true);
  }
  bsdf.coat = Clearcoat(c.coat, c.coatRoughness, c.coatNormal);
  bsdf.sheen = Sheen(c.sheenColor, c.sheenRoughness);
  LayersResult result;
  const BsdfAtWo at = bsdfAtWo(scene, bsdf, c.wo);
  const BsdfValue value = evaluateBsdf(scene, bsdf, at, c.wo, c.wi);
  result.fCos = value.fCos;
  result.pdf = value.pdfSolidAngle;
  const BsdfSample drawn = sampleDirection(scene, bsdf, at, c.wo, c.uLobe, c.u);
  result.sampledWi = drawn.wiLocal;
  result.weight = drawn.weight;
  result.sampledPdf = drawn.pdfSolidAngle;
  const BsdfValue again = evaluateBsdf(scene, bsdf, at, c.wo, drawn.wiLocal);
  result.fCosSampled = again.fCos;
  result.pdfAtSampled = again.pdfSolidAngle;
  result.flags = (drawn.delta ? kLayersDelta : 0u) | (drawn.valid ? kLayersValid : 0u);
  return result;
}
