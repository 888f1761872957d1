#version 460
#extension GL_GOOGLE_include_directive : require
#include "bsdf/direction_sampling.glsl"
#include "glsl/bsdf_case.h"
#define PROBE_INPUT BsdfCase
#define PROBE_OUTPUT BsdfResult
#include "support/probe_main.glsl"

BsdfResult probe(const BsdfCase c) {
  SceneRef scene = SceneRef(pc.extra);
  SurfaceBsdf m =
      bareSurface(metallicRoughness(c.baseColor, c.metallic, c.roughness, c.ior, c.specular, c.specularColor));
  setExactAlbedo(m.base, c.ior, c.exactAlbedo);
  setAnisotropy(m.base, c.anisotropy, c.anisotropicAlbedo);
  const bool thinWalled = c.thinWalled != 0u;
  if (c.transmission > 0.0) {
    setTransmission(m.base, c.transmission, relativeIor(c.ior, thinWalled || c.backFace == 0u), thinWalled);
    setGlassLoss(m.base, c.glassLoss, c.backFace == 0u);
  }
  if (c.diffuseTransmission > 0.0) {
    const bool refracts = c.transmission > 0.0 && !thinWalled;
    const float eta = refracts ? relativeIor(c.ior, c.backFace == 0u) : 1.0;
    setDiffuseTransmission(m.base, DiffuseTransmission(c.diffuseTransmission, c.diffuseTransmissionColor, eta),
                           thinWalled);
  }
  BsdfResult result;
  const BsdfAtWo at = bsdfAtWo(scene, m, c.wo);
  const BsdfValue value = evaluateBsdf(scene, m, at, c.wo, c.wi);
  result.fCos = value.fCos;
  result.pdf = value.pdfSolidAngle;
  const BsdfSample drawn = sampleDirection(scene, m, at, c.wo, c.uLobe, c.u);
  result.sampledWi = drawn.wiLocal;
  result.weight = drawn.weight;
  result.sampledPdf = drawn.pdfSolidAngle;
  const BsdfValue again = evaluateBsdf(scene, m, at, c.wo, drawn.wiLocal);
  result.fCosSampled = again.fCos;
  result.pdfAtSampled = again.pdfSolidAngle;
  result.flags = (drawn.delta ? kBsdfDelta : 0u) | (drawn.valid ? kBsdfValid : 0u);
  result.eta = drawn.eta;
  return result;
}
