// What a layer over the base, clearcoat or sheen, takes from the light that passes it. Formulas: docs/bsdf-layers.md,
// "Layers".
//
// A layer of albedo E lets T = 1 - E through. What lies below is multiplied by a symmetric function of wo and wi,
// chosen for each of its lobes such that a white lobe reflects exactly T(wo): what cannot leave tries again.
#ifndef ISOPHOTE_BSDF_LAYER_GLSL
#define ISOPHOTE_BSDF_LAYER_GLSL

#include "shared/bsdf_constants.h"
#include "shared/buffers.glsl"
#include "shared/constants.glsl"

/// Factors of the lobes below, in [0, about 1.1].
struct LayerPassage {
  float narrow; // of microfacet lobes
  vec3 broad;   // of diffuse lobes
};

/// Where a cosine and a layer's row lie in its table.
struct LayerCell {
  uint row;
  float rowFraction;
  uint column;
  float columnFraction;
};

/// @param position of the row, in [0, 1]: a clearcoat's roughness, a sheen's sheenRow
LayerCell layerCell(const float mu, const float position) {
  const float column = sqrt(clamp(mu, 0.0, 1.0)) * float(kLayerMuCount - 1u);
  const float row = clamp(position, 0.0, 1.0) * float(kLayerRoughnessCount - 1u);
  LayerCell cell;
  cell.column = min(uint(column), kLayerMuCount - 2u);
  cell.columnFraction = column - float(cell.column);
  cell.row = min(uint(row), kLayerRoughnessCount - 2u);
  cell.rowFraction = row - float(cell.row);
  return cell;
}

/// One of the table's functions of mu and the layer's row, bilinear.
float readLayer(FloatRef table, const uint start, const LayerCell cell) {
  const uint low = start + cell.row * kLayerMuCount + cell.column;
  const uint high = low + kLayerMuCount;
  const float t = cell.columnFraction;
  return mix(mix(table.items[low], table.items[low + 1u], t), mix(table.items[high], table.items[high + 1u], t),
             cell.rowFraction);
}

/// One of the table's functions of mu, the layer's row and another layer's roughness, trilinear.
float readLayerWith(FloatRef table, const uint start, const LayerCell cell, const float roughness) {
  const float position = clamp(roughness, 0.0, 1.0) * float(kLayerBaseCount - 1u);
  const uint b = min(uint(position), kLayerBaseCount - 2u);
  const uint rowStride = kLayerBaseCount * kLayerMuCount;
  const uint first = start + cell.row * rowStride + b * kLayerMuCount + cell.column;
  float rows[2];
  for (uint i = 0u; i < 2u; ++i) {
    const uint low = first + i * rowStride;
    const uint high = low + kLayerMuCount;
    rows[i] = mix(mix(table.items[low], table.items[low + 1u], cell.columnFraction),
                  mix(table.items[high], table.items[high + 1u], cell.columnFraction), position - float(b));
  }
  return mix(rows[0], rows[1], cell.rowFraction);
}

/// The coupling g(mu) with a microfacet base of roughness `baseRoughness`.
float readLayerNarrow(FloatRef table, const LayerCell cell, const float baseRoughness) {
  return readLayerWith(table, kLayerNarrow, cell, baseRoughness);
}

/// The cosine-weighted mean of the row's albedo.
float readLayerMean(FloatRef table, const LayerCell cell) {
  return mix(table.items[kLayerMean + cell.row], table.items[kLayerMean + cell.row + 1u], cell.rowFraction);
}

/// Shares of A and B that leave the layer.
vec2 readLayerThrough(FloatRef table, const LayerCell cell, const float baseRoughness) {
  return vec2(readLayerWith(table, kLayerThrough, cell, baseRoughness),
              readLayerWith(table, kLayerThrough + kLayerThroughStride, cell, baseRoughness));
}

/// Cosine-weighted means of A and B that leave the layer.
vec2 readLayerThroughMeans(FloatRef table, const LayerCell cell, const float baseRoughness) {
  const float position = clamp(baseRoughness, 0.0, 1.0) * float(kLayerBaseCount - 1u);
  const uint b = min(uint(position), kLayerBaseCount - 2u);
  vec2 rows[2];
  for (uint i = 0u; i < 2u; ++i) {
    const uint first = kLayerThroughMean + 2u * ((cell.row + i) * kLayerBaseCount + b);
    rows[i] = mix(vec2(table.items[first], table.items[first + 1u]),
                  vec2(table.items[first + 2u], table.items[first + 3u]), position - float(b));
  }
  return mix(rows[0], rows[1], cell.rowFraction);
}

/// The base below: microfacets, and of its diffuse lobe the coat that they are.
struct LayerBase {
  float roughness;
  float f90;
  float multiple;        // reflectance of scattering between facets
  vec2 meanAlbedo;       // (A, B) of white facets
  vec3 meanF0;           // of the coat
  vec3 meanTransmission; // > 0
};

/// The base in one direction.
struct LayerBaseAt {
  vec2 albedo;       // (A, B)
  vec3 f0;           // with f90 what the coat reflects: f0 A + f90 B
  vec3 transmission; // of the coat, > 0
};

/// What layers and white facets below them send back, of light from one direction or in the mean.
struct LayerReturn {
  float reflected; // by the layers
  vec2 facets;     // (A, B) that leaves them
  float lost;      // what is lost between facets, and would leave
};

/// Adds a share of the surface.
/// @param weight    of the share
/// @param reflected by its layers
/// @param facets    (A, B) that leaves them
void addReturn(inout LayerReturn sum, const float weight, const float reflected, const vec2 facets) {
  sum.reflected += weight * reflected;
  sum.facets += weight * facets;
  sum.lost += weight * max(1.0 - reflected - facets.x - facets.y, 0.0);
}

/// What layers and facets leave for the diffuse lobe to give back.
/// @param f0 of the coat, in the direction or in the mean
vec3 leftForDiffuse(const LayerReturn returned, const vec3 f0, const LayerBase base) {
  return max(1.0 - returned.reflected -
                 (f0 * returned.facets.x + base.f90 * returned.facets.y + base.multiple * returned.lost),
             vec3(0.0));
}

/// The smaller of both directions' transmissions, mixed in by the amount: reciprocal, and never more than T(wo)
/// whatever lies below.
float passageOfEither(FloatRef table, const LayerCell cellO, const LayerCell cellI, const float amount) {
  return 1.0 - amount * max(readLayer(table, kLayerAlbedo, cellO), readLayer(table, kLayerAlbedo, cellI));
}

#endif
