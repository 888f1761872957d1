// What surfaces send out by themselves.
#ifndef ISOPHOTE_LIGHT_EMISSION_GLSL
#define ISOPHOTE_LIGHT_EMISSION_GLSL

#include "geometry/alpha_test.glsl"
#include "geometry/surface.glsl"
#include "geometry/texture_slot.glsl"

/// Radiance that a surface emits to the side that surface.frontFace tells: its front, and its back where it is double
/// sided. Unlit materials emit nothing here.
vec3 emittedRadiance(const SceneRef scene, const SurfaceHit surface) {
  if (!kHasEmissiveTriangles || (surface.flags & kTriangleEmissive) == 0u) return vec3(0.0);
  MaterialRef materials = MaterialRef(scene.view.materials);
  const uint flags = materials.items[surface.material].flags;
  if (!surface.frontFace && (flags & kMaterialDoubleSided) == 0u) return vec3(0.0);
  if (kHasUnlit && (flags & kMaterialUnlit) != 0u) return vec3(0.0);
  const Geometry geometry = GeometryRef(scene.view.geometries).items[surface.geometry];
  const vec3 texel = readSlot(scene, geometry, surface.primitiveIndex, surface.barycentrics,
                              materials.items[surface.material].emissiveSlot, vec4(1.0))
                         .rgb;
  return materials.items[surface.material].emissive * texel;
}

/// Probability that a ray meets the surface at all: 1, or what the alpha test accepts on average. A light sample on a
/// surface carries this factor, because its shadow ray ends before it.
float surfaceCoverage(const SceneRef scene, const SurfaceHit surface) {
  if (!kHasAlpha || (surface.flags & kTriangleHasAlpha) == 0u) return 1.0;
  MaterialRef materials = MaterialRef(scene.view.materials);
  const Geometry geometry = GeometryRef(scene.view.geometries).items[surface.geometry];
  const float alpha =
      surfaceAlpha(scene, geometry, surface.primitiveIndex, surface.barycentrics,
                   materials.items[surface.material].baseColor.a, materials.items[surface.material].baseColorSlot);
  const uint mode = materials.items[surface.material].alphaMode;
  if (mode == kAlphaMask) return alpha >= materials.items[surface.material].alphaCutoff ? 1.0 : 0.0;
  if (mode == kAlphaBlend) return clamp(alpha, 0.0, 1.0);
  return 1.0;
}

#endif
