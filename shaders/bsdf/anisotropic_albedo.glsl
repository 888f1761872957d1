// Directional albedo of anisotropic facets, read from the tables that engine/src/upload/anisotropic_albedo.cpp
// computes. Layout: shared/bsdf_constants.h.
#ifndef ISOPHOTE_BSDF_ANISOTROPIC_ALBEDO_GLSL
#define ISOPHOTE_BSDF_ANISOTROPIC_ALBEDO_GLSL

#include "bsdf/table_cell.glsl"
#include "shared/bsdf_constants.h"
#include "shared/buffers.glsl"

/// @param table where the surface's table begins
/// @param point roughness and strength, clamped to the table's ranges
TableCell anisotropicCell(const SceneRef scene, const uint table, const vec2 point) {
  Vec2Ref items = Vec2Ref(scene.view.anisotropicAlbedo);
  const vec2 roughness = items.items[table];
  const vec2 strength = items.items[table + 1u];
  const uvec2 count = uvec2(roughness.x == roughness.y ? 1u : kAnisotropyRoughnessCount,
                            strength.x == strength.y ? 1u : kAnisotropyStrengthCount);
  return tableCell(table + kAnisotropyHeader, kAnisotropyPlane, count, vec2(roughness.x, strength.x),
                   vec2(roughness.y, strength.y), point);
}

/// Returns (A, B) for light leaving along w, linear in sqrt(mu), in the square root of the width that w sees, and in
/// roughness and strength.
///
/// @param width alpha along x and y, the first not below the second
/// Accuracy: see docs/bsdf.md, measured in tests/unit/anisotropic_albedo_test.cpp.
vec2 anisotropicAlbedo(const SceneRef scene, const TableCell cell, const vec2 width, const vec3 w) {
  const vec2 root = sqrt(width);
  const float seen = length(w.xy) > 0.0 ? sqrt(length(width * w.xy) / length(w.xy)) : root.x;
  const float azimuth = root.x > root.y ? clamp((seen - root.y) / (root.x - root.y), 0.0, 1.0) : 0.0;
  const vec2 position =
      vec2(sqrt(clamp(w.z, 0.0, 1.0)), azimuth) * vec2(kAnisotropyMuCount - 1u, kAnisotropyAzimuthCount - 1u);
  const uvec2 first = min(uvec2(position), uvec2(kAnisotropyMuCount - 2u, kAnisotropyAzimuthCount - 2u));
  const vec2 t = position - vec2(first);
  const uint at = first.y * kAnisotropyMuCount + first.x;
  Vec2Ref table = Vec2Ref(scene.view.anisotropicAlbedo);
  vec2 values[4];
  for (uint i = 0u; i < 4u; ++i) {
    const uint low = cell.planes[i] + at;
    const uint high = low + kAnisotropyMuCount;
    values[i] = mix(mix(table.items[low], table.items[low + 1u], t.x),
                    mix(table.items[high], table.items[high + 1u], t.x), t.y);
  }
  return mixPlanes(values, cell.fraction);
}

/// Returns the cosine-weighted mean of (A, B) over the hemisphere.
vec2 anisotropicMeanAlbedo(const SceneRef scene, const TableCell cell) {
  Vec2Ref table = Vec2Ref(scene.view.anisotropicAlbedo);
  vec2 means[4];
  for (uint i = 0u; i < 4u; ++i) means[i] = table.items[cell.planes[i] + kAnisotropyMean];
  return mixPlanes(means, cell.fraction);
}

#endif
