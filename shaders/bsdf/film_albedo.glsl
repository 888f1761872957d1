// Directional albedo of dielectric facets under a film, read from the tables that engine/src/upload/film_albedo.cpp
// computes. Layout: shared/bsdf_constants.h.
#ifndef ISOPHOTE_BSDF_FILM_ALBEDO_GLSL
#define ISOPHOTE_BSDF_FILM_ALBEDO_GLSL

#include "bsdf/table_cell.glsl"
#include "shared/bsdf_constants.h"
#include "shared/buffers.glsl"

/// @param table where the surface's table begins
/// @param point thickness in nm and roughness, clamped to the table's ranges
TableCell filmCell(const SceneRef scene, const uint table, const vec2 point) {
  Vec3Ref items = Vec3Ref(scene.view.filmAlbedo);
  const vec3 thickness = items.items[table];
  const vec3 roughness = items.items[table + 1u];
  return tableCell(table + kFilmHeader, kFilmPlane, uvec2(thickness.z, roughness.z), vec2(thickness.x, roughness.x),
                   vec2(thickness.y, roughness.y), point);
}

/// Returns the albedo, linear Rec.709, for light leaving at cosine mu, linear in sqrt(mu), thickness and roughness.
/// Accuracy: see docs/bsdf-layers.md, measured in tests/unit/film_albedo_test.cpp.
vec3 filmAlbedo(const SceneRef scene, const TableCell cell, const float mu) {
  const float position = sqrt(clamp(mu, 0.0, 1.0)) * float(kFilmMuCount - 1u);
  const uint column = min(uint(position), kFilmMuCount - 2u);
  Vec3Ref table = Vec3Ref(scene.view.filmAlbedo);
  vec3 values[4];
  for (uint i = 0u; i < 4u; ++i) {
    const uint at = cell.planes[i] + column;
    values[i] = mix(table.items[at], table.items[at + 1u], position - float(column));
  }
  return mixPlanes(values, cell.fraction);
}

/// Returns the cosine-weighted mean of filmAlbedo over the hemisphere.
vec3 filmMeanAlbedo(const SceneRef scene, const TableCell cell) {
  Vec3Ref table = Vec3Ref(scene.view.filmAlbedo);
  vec3 means[4];
  for (uint i = 0u; i < 4u; ++i) means[i] = table.items[cell.planes[i] + kFilmMuCount];
  return mixPlanes(means, cell.fraction);
}

#endif
