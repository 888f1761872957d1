// A control for the kernels' specialisation: the material of a renderer without textures, normals, layers or glass.
// Found before the product's file of this name when the control is compiled.
#ifndef ISOPHOTE_BSDF_MATERIAL_GLSL
#define ISOPHOTE_BSDF_MATERIAL_GLSL

#include "bsdf/dispersion.glsl"
#include "bsdf/surface_bsdf.glsl"
#include "geometry/surface.glsl"
#include "math/frame.glsl"
#include "shared/buffers.glsl"

struct SurfaceMaterial {
  SurfaceBsdf bsdf;
  vec3 baseColor;
  bool unlit;
};

SurfaceMaterial materialAt(const SceneRef scene, const SurfaceHit surface, const float eta, const uint channel) {
  const vec3 color = MaterialRef(scene.view.materials).items[surface.material].baseColor.rgb;
  return SurfaceMaterial(SurfaceBsdf(clamp(color, 0.0, 1.0)), color, false);
}

vec3 shadingNormal(const SceneRef scene, const SurfaceHit surface, const vec3 wo) { return surface.ns; }

Frame shadingFrame(const SceneRef scene, const SurfaceHit surface, const vec3 ns) { return frameFromNormal(ns); }

// Never called: what the kernel names under features of other materials.
float etaInAir(const SceneRef scene, const SurfaceHit surface, const uint channel) { return 1.0; }
void setClearcoatNormal(inout SurfaceMaterial material, const SceneRef scene, const SurfaceHit surface, const vec3 wo,
                        const Frame frame) {}

#endif
