// A control for the kernels' specialisation: the scattering of a renderer that knows nothing but Lambert's law. Found
// before the product's file of this name when the control is compiled.
#ifndef ISOPHOTE_BSDF_SURFACE_BSDF_GLSL
#define ISOPHOTE_BSDF_SURFACE_BSDF_GLSL

#include "math/constants.glsl"
#include "sampling/warp.glsl"
#include "shared/buffers.glsl"

const float kMinCosine = 1e-7;

struct SurfaceBsdf {
  vec3 reflectance;
};

struct BsdfValue {
  vec3 fCos;
  float pdfSolidAngle;
};

struct BsdfSample {
  vec3 wiLocal;
  vec3 weight;
  float pdfSolidAngle;
  bool delta;
  bool valid;
  float eta;
};

const bool kHasFarSide = false;

bool isGlass(const SurfaceBsdf bsdf) { return false; }
bool transmits(const SurfaceBsdf bsdf) { return false; }

struct BsdfAtWo {
  uint nothing;
};

BsdfAtWo bsdfAtWo(const SceneRef scene, const SurfaceBsdf bsdf, const vec3 woLocal) { return BsdfAtWo(0u); }

BsdfValue evaluateDirection(const SceneRef scene, const SurfaceBsdf bsdf, const BsdfAtWo at, const vec3 woLocal,
                            const vec3 wiLocal) {
  if (min(woLocal.z, wiLocal.z) < kMinCosine) return BsdfValue(vec3(0.0), 0.0);
  const float density = kInvPi * wiLocal.z;
  return BsdfValue(bsdf.reflectance * density, density);
}

BsdfSample absorbed() { return BsdfSample(vec3(0.0, 0.0, 1.0), vec3(0.0), 0.0, false, false, 1.0); }

BsdfSample drawBsdf(const vec3 woLocal, const vec2 u) {
  if (woLocal.z < kMinCosine) return absorbed();
  return BsdfSample(sampleCosineHemisphere(u), vec3(0.0), 0.0, false, true, 1.0);
}

BsdfSample sampleDirection(const SceneRef scene, const SurfaceBsdf bsdf, const BsdfAtWo at, const vec3 woLocal,
                           const float uLobe, const vec2 u) {
  BsdfSample drawn = drawBsdf(woLocal, u);
  if (!drawn.valid) return drawn;
  const BsdfValue value = evaluateDirection(scene, bsdf, at, woLocal, drawn.wiLocal);
  drawn.pdfSolidAngle = value.pdfSolidAngle;
  drawn.weight = value.pdfSolidAngle > 0.0 ? value.fCos / value.pdfSolidAngle : vec3(0.0);
  drawn.valid = max(drawn.weight.x, max(drawn.weight.y, drawn.weight.z)) > 0.0;
  return drawn;
}

#endif
