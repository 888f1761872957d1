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
  float broad;  // of diffuse lobes
};

/// Where a cosine and a layer's roughness lie in its table.
struct LayerCell {
  uint row;
  float rowFraction;
  uint column;
  float columnFraction;
};

LayerCell layerCell(const float mu, const float roughness) {
  const float column = sqrt(clamp(mu, 0.0, 1.0)) * float(kLayerMuCount - 1u);
  const float row = clamp(roughness, 0.0, 1.0) * float(kLayerRoughnessCount - 1u);
  LayerCell cell;
  cell.column = min(uint(column), kLayerMuCount - 2u);
  cell.columnFraction = column - float(cell.column);
  cell.row = min(uint(row), kLayerRoughnessCount - 2u);
  cell.rowFraction = row - float(cell.row);
  return cell;
}

/// One of the table's functions of mu and the layer's roughness, bilinear.
float readLayer(FloatRef table, const uint start, const LayerCell cell) {
  const uint low = start + cell.row * kLayerMuCount + cell.column;
  const uint high = low + kLayerMuCount;
  const float t = cell.columnFraction;
  return mix(mix(table.items[low], table.items[low + 1u], t), mix(table.items[high], table.items[high + 1u], t),
             cell.rowFraction);
}

/// The coupling g(mu) with a microfacet base of roughness `baseRoughness`, trilinear.
float readLayerNarrow(FloatRef table, const LayerCell cell, const float baseRoughness) {
  const float position = clamp(baseRoughness, 0.0, 1.0) * float(kLayerBaseCount - 1u);
  const uint b = min(uint(position), kLayerBaseCount - 2u);
  const uint rowStride = kLayerBaseCount * kLayerMuCount;
  const uint first = kLayerNarrow + cell.row * rowStride + b * kLayerMuCount + cell.column;
  float rows[2];
  for (uint i = 0u; i < 2u; ++i) {
    const uint low = first + i * rowStride;
    const uint high = low + kLayerMuCount;
    rows[i] = mix(mix(table.items[low], table.items[low + 1u], cell.columnFraction),
                  mix(table.items[high], table.items[high + 1u], cell.columnFraction), position - float(b));
  }
  return mix(rows[0], rows[1], cell.rowFraction);
}

/// What the table says at the row's roughness without a direction: x the mean albedo, yz the covariances of the albedo
/// with the integrals (A, B) of a GGX lobe of roughness `baseRoughness`.
vec3 readLayerMeans(FloatRef table, const LayerCell cell, const float baseRoughness) {
  const float position = clamp(baseRoughness, 0.0, 1.0) * float(kLayerBaseCount - 1u);
  const uint b = min(uint(position), kLayerBaseCount - 2u);
  vec3 rows[2];
  for (uint i = 0u; i < 2u; ++i) {
    const uint r = cell.row + i;
    const uint first = kLayerCovariance + 2u * (r * kLayerBaseCount + b);
    const vec2 low = vec2(table.items[first], table.items[first + 1u]);
    const vec2 high = vec2(table.items[first + 2u], table.items[first + 3u]);
    rows[i] = vec3(table.items[kLayerMean + r], mix(low, high, position - float(b)));
  }
  return mix(rows[0], rows[1], cell.rowFraction);
}

/// The base below a layer: of its diffuse lobe the microfacet coat that it lies under already.
struct LayerBase {
  float roughness;
  float f0;
  float f90;
  float meanTransmission; // of that coat, > 0
};

/// @param cellO, cellI of wo and wi at the layer's roughness
/// @param amount       coverage of the layer, in [0, 1]
LayerPassage layerPassage(FloatRef table, const LayerCell cellO, const LayerCell cellI, const float amount,
                          const LayerBase base) {
  const float passedO = 1.0 - readLayer(table, kLayerAlbedo, cellO);
  const float passedI = 1.0 - readLayer(table, kLayerAlbedo, cellI);
  const vec3 means = readLayerMeans(table, cellO, base.roughness);
  // Mean of the product of both coats' transmissions over the mean of the lower one's.
  const float mean = 1.0 - means.x + (base.f0 * means.y + base.f90 * means.z) / base.meanTransmission;
  const float narrow = readLayerNarrow(table, cellO, base.roughness) * readLayerNarrow(table, cellI, base.roughness);
  LayerPassage passage;
  passage.narrow = 1.0 + amount * (narrow - 1.0);
  passage.broad = 1.0 + amount * (passedO * passedI / mean - 1.0);
  return passage;
}

/// The smaller of both directions' transmissions, mixed in by the amount: reciprocal, and never more than T(wo)
/// whatever lies below.
float passageOfEither(FloatRef table, const LayerCell cellO, const LayerCell cellI, const float amount) {
  return 1.0 - amount * max(readLayer(table, kLayerAlbedo, cellO), readLayer(table, kLayerAlbedo, cellI));
}

#endif
