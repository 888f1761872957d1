// Directional albedo of dielectric facets under a film, read from the tables that engine/src/upload/film_albedo.cpp
// computes. Layout: shared/bsdf_constants.h.
#ifndef ISOPHOTE_BSDF_FILM_ALBEDO_GLSL
#define ISOPHOTE_BSDF_FILM_ALBEDO_GLSL

#include "shared/bsdf_constants.h"
#include "shared/buffers.glsl"

/// The four planes around a thickness and roughness, and where the point lies between them.
struct FilmCell {
  uint planes[4];
  vec2 fraction;
};

/// @param table where the surface's table begins
/// @param point thickness in nm and roughness, clamped to the table's ranges
FilmCell filmCell(const SceneRef scene, const uint table, const vec2 point) {
  Vec3Ref items = Vec3Ref(scene.view.filmAlbedo);
  const vec3 thickness = items.items[table];
  const vec3 roughness = items.items[table + 1u];
  const uvec2 count = uvec2(thickness.z, roughness.z);
  const vec2 low = vec2(thickness.x, roughness.x);
  const vec2 range = max(vec2(thickness.y, roughness.y) - low, vec2(1e-9));
  const vec2 position = clamp((point - low) / range, 0.0, 1.0) * vec2(count - 1u);
  const uvec2 first = min(uvec2(position), count - 1u);
  const uvec2 second = min(first + 1u, count - 1u);
  const uint planes = table + kFilmHeader;
  FilmCell cell;
  cell.planes[0] = planes + (first.y * count.x + first.x) * kFilmPlane;
  cell.planes[1] = planes + (first.y * count.x + second.x) * kFilmPlane;
  cell.planes[2] = planes + (second.y * count.x + first.x) * kFilmPlane;
  cell.planes[3] = planes + (second.y * count.x + second.x) * kFilmPlane;
  cell.fraction = position - vec2(first);
  return cell;
}

/// Returns the albedo, linear Rec.709, for light leaving at cosine mu, linear in sqrt(mu), thickness and roughness.
/// Accuracy: see docs/bsdf-layers.md, measured in tests/unit/film_albedo_test.cpp.
vec3 filmAlbedo(const SceneRef scene, const FilmCell cell, const float mu) {
  const float position = sqrt(clamp(mu, 0.0, 1.0)) * float(kFilmMuCount - 1u);
  const uint column = min(uint(position), kFilmMuCount - 2u);
  Vec3Ref table = Vec3Ref(scene.view.filmAlbedo);
  vec3 values[4];
  for (uint i = 0u; i < 4u; ++i) {
    const uint at = cell.planes[i] + column;
    values[i] = mix(table.items[at], table.items[at + 1u], position - float(column));
  }
  return mix(mix(values[0], values[1], cell.fraction.x), mix(values[2], values[3], cell.fraction.x), cell.fraction.y);
}

/// Returns the cosine-weighted mean of filmAlbedo over the hemisphere.
vec3 filmMeanAlbedo(const SceneRef scene, const FilmCell cell) {
  Vec3Ref table = Vec3Ref(scene.view.filmAlbedo);
  vec3 means[4];
  for (uint i = 0u; i < 4u; ++i) means[i] = table.items[cell.planes[i] + kFilmMuCount];
  return mix(mix(means[0], means[1], cell.fraction.x), mix(means[2], means[3], cell.fraction.x), cell.fraction.y);
}

#endif
