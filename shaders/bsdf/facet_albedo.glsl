// Directional albedo of isotropic facets, read from the table that engine/src/upload/facet_albedo.cpp computes.
//
// Each entry is (A, B): the integral over wi of D V cos with Fresnel weights 1 - (1-c)^5 and (1-c)^5, so that a lobe of
// Schlick reflectance (f0, f90) has the albedo f0 A + f90 B. Layout: shared/bsdf_constants.h.
#ifndef ISOPHOTE_BSDF_FACET_ALBEDO_GLSL
#define ISOPHOTE_BSDF_FACET_ALBEDO_GLSL

#include "shared/bsdf_constants.h"
#include "shared/buffers.glsl"

/// Returns (A, B) for light leaving along a direction of cosine mu, bilinear in sqrt(mu) and roughness.
///
/// @param start where the table it begins: 0, or MetallicRoughness::exactAlbedo
/// @param mu    in [0, 1], clamped
/// @param alpha roughness squared, in [0, 1]; 0 gives the smooth mirror's exact limit at the table's nodes
/// Accuracy: see docs/bsdf.md, measured in tests/unit/facet_albedo_test.cpp.
vec2 isotropicAlbedo(const SceneRef scene, const uint start, const float mu, const float alpha) {
  if (scene.view.facetAlbedo == 0ul) return vec2(0.0); // an all-features kernel on a scene without specular surfaces
  const float column = sqrt(clamp(mu, 0.0, 1.0)) * float(kFacetAlbedoMuCount - 1u);
  const float row = sqrt(clamp(alpha, 0.0, 1.0)) * float(kFacetAlbedoRoughnessCount - 1u);
  const uint c = min(uint(column), kFacetAlbedoMuCount - 2u);
  const uint r = min(uint(row), kFacetAlbedoRoughnessCount - 2u);
  Vec2Ref table = Vec2Ref(scene.view.facetAlbedo);
  const uint first = start + r * kFacetAlbedoMuCount + c;
  const uint second = first + kFacetAlbedoMuCount;
  const float t = column - float(c);
  return mix(mix(table.items[first], table.items[first + 1u], t), mix(table.items[second], table.items[second + 1u], t),
             row - float(r));
}

/// Returns the cosine-weighted mean of (A, B) over the hemisphere, 2 times the integral of (A, B) mu over mu.
vec2 isotropicMeanAlbedo(const SceneRef scene, const uint start, const float alpha) {
  if (scene.view.facetAlbedo == 0ul) return vec2(0.0);
  const float row = sqrt(clamp(alpha, 0.0, 1.0)) * float(kFacetAlbedoRoughnessCount - 1u);
  const uint r = min(uint(row), kFacetAlbedoRoughnessCount - 2u);
  Vec2Ref means = Vec2Ref(scene.view.facetAlbedo);
  const uint first = start + kFacetAlbedoMeans + r;
  return mix(means.items[first], means.items[first + 1u], row - float(r));
}

#endif
