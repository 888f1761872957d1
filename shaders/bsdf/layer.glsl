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

/// What the table says of the row without a direction: x the mean albedo, yz the covariances of the albedo with the
/// integrals (A, B) of a GGX lobe of roughness `baseRoughness`.
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

/// The same of the sheen's light that a clearcoat of roughness `coatRoughness` above it takes: the mean of kCoatedSheen
/// and its covariances.
vec3 readCoatedSheenMeans(FloatRef table, const LayerCell cell, const float coatRoughness, const float baseRoughness) {
  const vec2 position = clamp(vec2(coatRoughness, baseRoughness), 0.0, 1.0) * float(kLayerBaseCount - 1u);
  const uvec2 low = min(uvec2(position), uvec2(kLayerBaseCount - 2u));
  const vec2 fraction = position - vec2(low);
  vec3 sum = vec3(0.0);
  for (uint i = 0u; i < 8u; ++i) {
    const uvec3 corner = uvec3(i & 1u, (i >> 1u) & 1u, i >> 2u);
    const float weight = (corner.x == 1u ? cell.rowFraction : 1.0 - cell.rowFraction) *
                         (corner.y == 1u ? fraction.x : 1.0 - fraction.x) *
                         (corner.z == 1u ? fraction.y : 1.0 - fraction.y);
    const uint pair = (cell.row + corner.x) * kLayerBaseCount + low.x + corner.y;
    const uint covariance = kCoatedSheenCovariance + 2u * (pair * kLayerBaseCount + low.y + corner.z);
    sum += weight * vec3(table.items[kCoatedSheenMean + pair], table.items[covariance], table.items[covariance + 1u]);
  }
  return sum;
}

/// The base below a layer: of its diffuse lobe the microfacet coat that it lies under already.
struct LayerBase {
  float roughness;
  float f0;
  float f90;
  float multiple;         // reflectance of scattering between facets
  vec2 meanAlbedo;        // (A, B) of white facets
  float meanTransmission; // of that coat, > 0
};

/// That coat in one direction.
struct LayerBaseAt {
  vec2 albedo;        // (A, B)
  float transmission; // > 0
};

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

/// What the layer and the facets below it leave for the diffuse lobe to give back, in one direction or in the mean.
/// @param reflected by the layer
/// @param albedo    (A, B) of the facets without it
/// @param through   and what of that leaves it
float leftForDiffuse(const float reflected, const vec2 albedo, const vec2 through, const float amount,
                     const LayerBase base) {
  const float lost = max(1.0 - albedo.x - albedo.y, 0.0);
  const float lostThrough = max(1.0 - reflected - through.x - through.y, 0.0);
  const vec2 facets = mix(albedo, through, amount);
  return 1.0 - amount * reflected -
         (base.f0 * facets.x + base.f90 * facets.y + base.multiple * mix(lost, lostThrough, amount));
}

/// Mean over the hemisphere of what layers pass times what the coat of the base passes, over the mean of the latter.
/// @param lost of light on its way through the layers, as readLayerMeans has it
float meanPassed(const vec3 lost, const LayerBase base) {
  return 1.0 - lost.x + (base.f0 * lost.y + base.f90 * lost.z) / base.meanTransmission;
}

/// @param cellO, cellI of wo and wi in the layer's row
/// @param amount       coverage of the layer, in [0, 1]
LayerPassage layerPassage(FloatRef table, const LayerCell cellO, const LayerCell cellI, const float amount,
                          const LayerBase base, const LayerBaseAt baseO, const LayerBaseAt baseI) {
  const float leftO = leftForDiffuse(readLayer(table, kLayerAlbedo, cellO), baseO.albedo,
                                     baseO.albedo * readLayerThrough(table, cellO, base.roughness), amount, base);
  const float leftI = leftForDiffuse(readLayer(table, kLayerAlbedo, cellI), baseI.albedo,
                                     baseI.albedo * readLayerThrough(table, cellI, base.roughness), amount, base);
  const float mean = leftForDiffuse(readLayerMeans(table, cellO, base.roughness).x, base.meanAlbedo,
                                    readLayerThroughMeans(table, cellO, base.roughness), amount, base);
  const float narrow = readLayerNarrow(table, cellO, base.roughness) * readLayerNarrow(table, cellI, base.roughness);
  LayerPassage passage;
  passage.narrow = 1.0 + amount * (narrow - 1.0);
  // In place of the coat's own transmissions, by which the base has multiplied its diffuse lobe.
  passage.broad = max(leftO, 0.0) * max(leftI, 0.0) * base.meanTransmission /
                  (max(mean, kMinCoatTransmission) * baseO.transmission * baseI.transmission);
  return passage;
}

/// The smaller of both directions' transmissions, mixed in by the amount: reciprocal, and never more than T(wo)
/// whatever lies below.
float passageOfEither(FloatRef table, const LayerCell cellO, const LayerCell cellI, const float amount) {
  return 1.0 - amount * max(readLayer(table, kLayerAlbedo, cellO), readLayer(table, kLayerAlbedo, cellI));
}

#endif
