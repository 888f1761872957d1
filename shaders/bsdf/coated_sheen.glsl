// A sheen under a clearcoat: what both do that neither does alone, read from the table of
// engine/src/upload/layer_tables.cpp. Formulas: docs/bsdf-layers.md, "Layers". Layout: shared/bsdf_constants.h.
#ifndef ISOPHOTE_BSDF_COATED_SHEEN_GLSL
#define ISOPHOTE_BSDF_COATED_SHEEN_GLSL

#include "bsdf/layer.glsl"

struct CoatedSheen {
  float taken;    // by the coat from the sheen's light
  float coupling; // of both with facets, over that of the coat alone
  vec2 through;   // shares of the facets' A and B that leave both
};

/// The eight corners around a sheen's row, a coat's roughness and a base's, linear.
struct CoatedSheenCell {
  uint first; // item of the lowest corner
  vec3 fraction;
};

CoatedSheenCell coatedSheenCell(const LayerCell sheen, const float coatRoughness, const float baseRoughness) {
  const vec2 position =
      clamp(vec2(coatRoughness, baseRoughness), 0.0, 1.0) * vec2(kCoatedSheenCoatCount - 1u, kLayerBaseCount - 1u);
  const uvec2 low = min(uvec2(position), uvec2(kCoatedSheenCoatCount - 2u, kLayerBaseCount - 2u));
  CoatedSheenCell cell;
  cell.first = ((sheen.row * kCoatedSheenCoatCount + low.x) * kLayerBaseCount + low.y) * kCoatedSheenStride;
  cell.fraction = vec3(sheen.rowFraction, position - vec2(low));
  return cell;
}

// Item of one corner, and its weight.
uint coatedSheenCorner(const CoatedSheenCell cell, const uint i, out float weight) {
  const uvec3 corner = uvec3(i & 1u, (i >> 1u) & 1u, i >> 2u);
  const vec3 weights = mix(1.0 - cell.fraction, cell.fraction, vec3(corner));
  weight = weights.x * weights.y * weights.z;
  return cell.first + ((corner.x * kCoatedSheenCoatCount + corner.y) * kLayerBaseCount + corner.z) * kCoatedSheenStride;
}

CoatedSheen readCoatedSheen(Vec4Ref table, const CoatedSheenCell cell, const LayerCell sheen) {
  vec4 sum = vec4(0.0);
  for (uint i = 0u; i < 8u; ++i) {
    float weight;
    const uint at = coatedSheenCorner(cell, i, weight) + sheen.column;
    sum += weight * mix(table.items[at], table.items[at + 1u], sheen.columnFraction);
  }
  return CoatedSheen(sum.x, sum.y, sum.zw);
}

/// Cosine-weighted means: x of what the coat takes, yz of A and B that leave both.
vec3 readCoatedSheenMeans(Vec4Ref table, const CoatedSheenCell cell) {
  vec3 sum = vec3(0.0);
  for (uint i = 0u; i < 8u; ++i) {
    float weight;
    const uint at = coatedSheenCorner(cell, i, weight) + kLayerMuCount;
    sum += weight * table.items[at].xzw;
  }
  return sum;
}

#endif
