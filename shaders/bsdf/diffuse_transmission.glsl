// KHR_materials_diffuse_transmission: Lambert lobes on both sides of a surface. Formulas: docs/bsdf.md.
#ifndef ISOPHOTE_BSDF_DIFFUSE_TRANSMISSION_GLSL
#define ISOPHOTE_BSDF_DIFFUSE_TRANSMISSION_GLSL

#include "shared/constants.glsl"

struct DiffuseTransmission {
  float share; // of the diffuse light that crosses towards the denser side, in [0, 1]
  vec3 color;  // of what crosses, linear, in [0, 1]
  float eta;   // index behind the surface over the index in front of it; 1 of thin walls and where nothing refracts
};

const DiffuseTransmission kNoDiffuseTransmission = DiffuseTransmission(0.0, vec3(0.0), 1.0);

/// Share of the diffuse light from wo's side that crosses. Towards the rarer side only 1 / index^2 of it can, or light
/// would flow from one side of a closed body to the other on its own.
float crossingShare(const DiffuseTransmission t) {
  return kHasDiffuseTransmission ? t.share * min(t.eta * t.eta, 1.0) : 0.0;
}

/// The Lambert lobe's reflectance of radiance from the other side, which carries 1 / eta^2: reciprocal with
/// crossingShare seen from there.
vec3 crossingReflectance(const DiffuseTransmission t) { return t.color * (t.share * min(1.0 / (t.eta * t.eta), 1.0)); }

#endif
