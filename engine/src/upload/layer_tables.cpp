#include "upload/layer_tables.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <future>

#include "upload/layer_coupling.hpp"
#include "upload/memo.hpp"
#include "upload/sheen_lobe.hpp"

namespace isophote {
namespace {

constexpr uint32_t kMuCount = kLayerNodeCount;

LayerRow remainder(const LayerRow& reflected) {
  LayerRow passed;
  std::transform(reflected.begin(), reflected.end(), passed.begin(), [](double e) { return std::max(1 - e, 0.0); });
  return passed;
}

struct LayerLobe {
  LayerRow albedo; ///< of the lobe as it is evaluated
  LayerRow scale;  ///< of the lobe, at wo and at wi
};

/// @param lobe of a row
std::vector<float> computeTable(const FacetModel& model, const std::function<LayerLobe(uint32_t)>& lobe) {
  std::vector<float> table(gpu::kLayerTableSize);
  const WhiteBases& bases = whiteBases(model);
  for (uint32_t r = 0; r < gpu::kLayerRoughnessCount; ++r) {
    const LayerLobe layer = lobe(r);
    std::copy(layer.albedo.begin(), layer.albedo.end(), &table[gpu::kLayerAlbedo + r * kMuCount]);
    std::copy(layer.scale.begin(), layer.scale.end(), &table[gpu::kLayerScale + r * kMuCount]);
    table[gpu::kLayerMean + r] = static_cast<float>(mean(layer.albedo));
    const LayerRow passed = remainder(layer.albedo);
    for (uint32_t b = 0; b < gpu::kLayerBaseCount; ++b) {
      const uint32_t cell = r * gpu::kLayerBaseCount + b;
      const std::array<LayerRow, 2> facets = facetRows(model, layerBaseRoughness(b));
      const LayerRow g = layerCoupling(bases, b, passed);
      const std::array<LayerRow, 2> through = leavingShares(bases, b, passed, g);
      std::copy(g.begin(), g.end(), &table[gpu::kLayerNarrow + cell * kMuCount]);
      for (uint32_t i = 0; i < 2; ++i) {
        std::copy(through[i].begin(), through[i].end(),
                  &table[gpu::kLayerThrough + i * gpu::kLayerThroughStride + cell * kMuCount]);
        table[gpu::kLayerThroughMean + 2 * cell + i] = static_cast<float>(meanOfProduct(facets[i], through[i]));
      }
    }
  }
  return table;
}

LayerRow clearcoatAlbedo(const FacetModel& model, double roughness) {
  const std::array<LayerRow, 2> facets = facetRows(model, roughness);
  LayerRow albedo;
  for (uint32_t c = 0; c < kMuCount; ++c) albedo[c] = double(gpu::kClearcoatF0) * facets[0][c] + facets[1][c];
  return albedo;
}

LayerLobe clearcoatLobe(const FacetModel& model, uint32_t row) {
  LayerLobe lobe;
  lobe.albedo = clearcoatAlbedo(model, row / double(gpu::kLayerRoughnessCount - 1));
  lobe.scale.fill(1);
  return lobe;
}

// ---- A sheen under a clearcoat ----

/// What the coat takes from the sheen's light: the larger of its albedos at both directions.
LayerRow takenFromSheen(const SheenLobe& sheen, const LayerRow& coat) {
  LayerRow taken{};
  for (uint32_t c = 0; c < kMuCount; ++c) {
    for (uint32_t k = 0; k < kMuCount; ++k) taken[c] += sheen.shares[c][k] * std::max(coat[c], coat[k]);
  }
  return taken;
}

/// The items of one pair of layers over one base: columns, then means.
void addCoatedSheen(const WhiteBases& bases, uint32_t b, const std::array<LayerRow, 2>& facets, const LayerRow& coat,
                    const SheenLobe& sheen, const LayerRow& taken, glm::vec4* items) {
  LayerRow both;
  for (uint32_t c = 0; c < kMuCount; ++c) both[c] = coat[c] + sheen.albedo[c] - taken[c];
  const LayerRow passed = remainder(both);
  const LayerRow underCoat = layerCoupling(bases, b, remainder(coat));
  const LayerRow underSheen = layerCoupling(bases, b, remainder(sheen.albedo));
  LayerRow product;
  std::transform(underCoat.begin(), underCoat.end(), underSheen.begin(), product.begin(), std::multiplies());
  const LayerRow g = layerCoupling(bases, b, passed, product, 8);
  const std::array<LayerRow, 2> through = leavingShares(bases, b, passed, g);
  for (uint32_t c = kMuCount; c-- > 0;) { // a smooth coat passes nothing at mu = 0: there as beside it
    const double ratio = underCoat[c] > 1e-6 || c + 1 == kMuCount ? g[c] / underCoat[c] : double(items[c + 1].y);
    items[c] = glm::vec4(taken[c], ratio, through[0][c], through[1][c]);
  }
  items[kMuCount] =
      glm::vec4(mean(taken), 0, meanOfProduct(facets[0], through[0]), meanOfProduct(facets[1], through[1]));
}

std::vector<glm::vec4> computeCoatedSheen(const FacetModel& model) {
  std::vector<glm::vec4> table(gpu::kCoatedSheenSize);
  const WhiteBases& bases = whiteBases(model);
  std::array<std::array<LayerRow, 2>, gpu::kLayerBaseCount> facets;
  for (uint32_t b = 0; b < gpu::kLayerBaseCount; ++b) facets[b] = facetRows(model, layerBaseRoughness(b));
  const auto row = [&](uint32_t r) {
    const SheenLobe sheen = sheenLobe(r);
    for (uint32_t q = 0; q < gpu::kCoatedSheenCoatCount; ++q) {
      const LayerRow coat = clearcoatAlbedo(model, q / double(gpu::kCoatedSheenCoatCount - 1));
      const LayerRow taken = takenFromSheen(sheen, coat);
      for (uint32_t b = 0; b < gpu::kLayerBaseCount; ++b) {
        const uint32_t cell = (r * gpu::kCoatedSheenCoatCount + q) * gpu::kLayerBaseCount + b;
        addCoatedSheen(bases, b, facets[b], coat, sheen, taken, &table[cell * gpu::kCoatedSheenStride]);
      }
    }
  };
  std::vector<std::future<void>> rows;
  for (uint32_t r = 0; r < gpu::kLayerRoughnessCount; ++r) rows.push_back(std::async(std::launch::async, row, r));
  for (auto& done : rows) done.get();
  return table;
}

} // namespace

const std::vector<float>& clearcoatTable(const FacetModel& model) {
  static Memo<FacetModel, std::vector<float>> tables;
  return tables.get(model, [&] { return computeTable(model, [&](uint32_t r) { return clearcoatLobe(model, r); }); });
}

const std::vector<float>& sheenTable(const FacetModel& model) {
  static Memo<FacetModel, std::vector<float>> tables;
  return tables.get(model, [&] {
    return computeTable(model, [](uint32_t r) {
      const SheenLobe lobe = sheenLobe(r);
      return LayerLobe{lobe.albedo, lobe.scale};
    });
  });
}

const std::vector<glm::vec4>& coatedSheenTable(const FacetModel& model) {
  static Memo<FacetModel, std::vector<glm::vec4>> tables;
  return tables.get(model, [&] { return computeCoatedSheen(model); });
}

} // namespace isophote
