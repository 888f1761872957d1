// Whether a candidate hit of a masked or blended surface exists for this sample.
#ifndef ISOPHOTE_GEOMETRY_ALPHA_TEST_GLSL
#define ISOPHOTE_GEOMETRY_ALPHA_TEST_GLSL

#include "geometry/texture_slot.glsl"
#include "sampling/hash.glsl"

// Who asks: the random choice of a blended surface is a pure function of this and of the triangle.
struct AlphaKey {
  uint pixel; // x | y << 16
  uint sampleIndex;
  uvec2 seed;
  uint vertex; // number of the path vertex that the ray leaves; shadow rays set its highest bit
};

/// A number in [0, 1) for one candidate of one ray, independent of the path's pairs (sampling/sampler.glsl).
float alphaThreshold(const AlphaKey key, const uint instance, const uint geometry, const uint primitiveIndex) {
  const uvec4 state = pcg4d(uvec4(key.pixel, key.sampleIndex, key.seed));
  return unitFloat(pcg4d(state ^ uvec4(instance, geometry, primitiveIndex, key.vertex)).x);
}

/// Base color alpha at a point of a triangle: factor x texture x vertex color.
float surfaceAlpha(const SceneRef scene, const Geometry geometry, const uint primitiveIndex, const vec2 barycentrics,
                   const float factor, const uint baseColorSlot) {
  const float texel = readSlot(scene, geometry, primitiveIndex, barycentrics, baseColorSlot, vec4(1.0)).a;
  return factor * texel * interpolateColor(scene, geometry, primitiveIndex, barycentrics).a;
}

/// True where the surface is there: alpha >= cutoff for masks, with probability alpha for blends.
bool passesAlphaTest(const SceneRef scene, const AlphaKey key, const uint instance, const uint geometryIndex,
                     const uint primitiveIndex, const vec2 barycentrics) {
  const Geometry geometry = GeometryRef(scene.view.geometries).items[geometryIndex];
  MaterialRef materials = MaterialRef(scene.view.materials);
  const float alpha =
      surfaceAlpha(scene, geometry, primitiveIndex, barycentrics, materials.items[geometry.material].baseColor.a,
                   materials.items[geometry.material].baseColorSlot);
  const uint mode = materials.items[geometry.material].alphaMode;
  if (mode == kAlphaMask) return alpha >= materials.items[geometry.material].alphaCutoff;
  if (mode == kAlphaBlend) return alphaThreshold(key, instance, geometryIndex, primitiveIndex) < alpha;
  return true;
}

#endif
