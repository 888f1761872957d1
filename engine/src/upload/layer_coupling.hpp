// How a layer couples with white microfacets below it. Formulas: docs/bsdf-layers.md, "Layers".
#pragma once

#include <array>
#include <cstdint>

#include "shared/bsdf_constants.h"
#include "upload/facets.hpp"

namespace isophote {

constexpr uint32_t kLayerNodeCount = gpu::kLayerMuCount;

/// One function of mu at the nodes mu = (c / (kLayerNodeCount - 1))^2, linear in sqrt(mu) between, as the device reads
/// it.
using LayerRow = std::array<double, kLayerNodeCount>;

/// Row c: the share of light of node c that node k receives.
using LayerTransport = std::array<LayerRow, kLayerNodeCount>;

[[nodiscard]] inline double layerNodeRoot(uint32_t column) { return column / double(kLayerNodeCount - 1); }
[[nodiscard]] inline double layerNodeMu(uint32_t column) { return layerNodeRoot(column) * layerNodeRoot(column); }

/// Roughness of the base number b, in [0, kLayerBaseCount).
[[nodiscard]] inline double layerBaseRoughness(uint32_t b) { return b / double(gpu::kLayerBaseCount - 1); }

/// Cosine-weighted mean over the hemisphere, of a row or of a product of two.
[[nodiscard]] double meanOfProduct(const LayerRow& a, const LayerRow& b);
[[nodiscard]] double mean(const LayerRow& row);

/// Parts a weight at mu between the nodes around it.
void spread(LayerRow& shares, double mu, double weight);

/// (A, B) of facets of one roughness, from the device's own table.
[[nodiscard]] std::array<LayerRow, 2> facetRows(const FacetModel& model, double roughness);

/// What a white base of microfacets does with light, by cosines alone.
struct WhiteBase {
  LayerTransport all;     ///< where it sends light; rows sum to 1
  LayerTransport single;  ///< by one reflection at a facet
  LayerTransport grazing; ///< the part of that which Schlick's approximation weighs by f90
};

using WhiteBases = std::array<WhiteBase, gpu::kLayerBaseCount>;

/// The base of each layerBaseRoughness, computed at the first call for a model; the first is a mirror, and empty.
[[nodiscard]] const WhiteBases& whiteBases(const FacetModel& model);

/// The coupling g with g(mu) * (mean of g where the base sends light of mu) = passed(mu).
/// @param b     number of the base
/// @param start near g
/// @param steps each halves what is left of the error
[[nodiscard]] LayerRow layerCoupling(const WhiteBases& bases, uint32_t b, const LayerRow& passed, const LayerRow& start,
                                     int steps);

/// The same from the root of `passed` on.
[[nodiscard]] LayerRow layerCoupling(const WhiteBases& bases, uint32_t b, const LayerRow& passed);

/// The shares of the facets' albedo, by Schlick's weights A and B, that leave a layer of coupling g.
[[nodiscard]] std::array<LayerRow, 2> leavingShares(const WhiteBases& bases, uint32_t b, const LayerRow& passed,
                                                    const LayerRow& g);

} // namespace isophote
