// Pixel filters by importance sampling: every sample has weight 1 (Ernst, Stamminger and Greiner 2006, "Filter
// Importance Sampling"), so a constant image stays constant at every border.
#ifndef ISOPHOTE_CAMERA_PIXEL_FILTER_GLSL
#define ISOPHOTE_CAMERA_PIXEL_FILTER_GLSL

#include "shared/buffers.glsl"
#include "shared/camera_types.h"

/// Offset along one axis at probability u.
float sampleFilterAxis(const FloatRef table, float u) {
  const float x = u * float(kFilterTableSize - 1u);
  const uint i = min(uint(x), kFilterTableSize - 2u);
  return mix(table.items[i], table.items[i + 1u], x - float(i));
}

/// Samples a separable pixel filter.
///
/// @param table  kFilterTableSize values, see shared/camera_types.h
/// @param u      in [0, 1)
/// @return       offset from the pixel's center, pixels
vec2 sampleFilter(const FloatRef table, vec2 u) {
  return vec2(sampleFilterAxis(table, u.x), sampleFilterAxis(table, u.y));
}

#endif
