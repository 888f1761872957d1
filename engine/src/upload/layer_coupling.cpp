#include "upload/layer_coupling.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <glm/glm.hpp>

#include "upload/facet_albedo.hpp"
#include "upload/memo.hpp"

namespace isophote {
namespace {

constexpr uint32_t kCount = kLayerNodeCount;

/// One row by visible normals, as in facet_albedo.cpp.
void addReflectedShares(const Facets& facets, double mu, LayerRow& shares, LayerRow& grazing) {
  const glm::dvec3 wo(std::sqrt(1 - mu * mu), 0, mu);
  const double lengthO = facets.projectedLength(wo);
  forVisibleNormals(facets, wo, {32, 16, true}, [&](const glm::dvec3& wm, double cosine, double weight) {
    const glm::dvec3 wi = 2 * cosine * wm - wo;
    if (wi.z <= 0) return;
    const double share = weight * facets.passage(wo, lengthO, wi);
    spread(shares, wi.z, share);
    spread(grazing, wi.z, share * std::pow(1 - cosine, 5));
  });
}

/// What single reflection loses returns by the cosine and its own loss, as in Kulla and Conty 2017, "Revisiting
/// Physically Based Shading at Imageworks".
WhiteBase whiteBase(const FacetModel& model, double roughness) {
  const Facets facets(model, glm::dvec2(roughness * roughness));
  WhiteBase base{};
  LayerTransport& transport = base.all;
  LayerRow lost{};
  for (uint32_t c = 0; c < kCount; ++c) {
    addReflectedShares(facets, layerNodeMu(c), base.single[c], base.grazing[c]);
    transport[c] = base.single[c];
    double sum = 0;
    for (const double share : transport[c]) sum += share;
    lost[c] = std::max(1 - sum, 0.0);
  }
  LayerRow returned{};
  for (uint32_t c = 0; c + 1 < kCount; ++c) { // the cosine's own shares of the nodes, weighed by what they lose
    constexpr int kSteps = 8;
    for (int i = 0; i < kSteps; ++i) {
      const double t = (i + 0.5) / kSteps;
      const double x = std::lerp(layerNodeRoot(c), layerNodeRoot(c + 1), t);
      spread(returned, x * x, 4 * x * x * x * std::lerp(lost[c], lost[c + 1], t));
    }
  }
  double total = 0;
  for (const double share : returned) total += share;
  for (uint32_t c = 0; c < kCount; ++c) {
    double sum = 0;
    for (uint32_t k = 0; k < kCount; ++k) sum += transport[c][k] += total > 0 ? lost[c] * returned[k] / total : 0;
    for (double& share : transport[c]) share /= sum;
  }
  return base;
}

double received(const LayerRow& shares, const LayerRow& g) {
  double sum = 0;
  for (uint32_t k = 0; k < kCount; ++k) sum += shares[k] * g[k];
  return sum;
}

} // namespace

double meanOfProduct(const LayerRow& a, const LayerRow& b) {
  // With x = sqrt(mu), 2 mu dmu = 4 x^3 dx: three Gauss-Legendre nodes an interval are exact for x^3 times a product of
  // linear functions.
  const double offset = std::sqrt(0.6) / 2;
  double sum = 0;
  for (uint32_t c = 0; c + 1 < kCount; ++c) {
    for (const auto& [t, weight] : {std::pair(0.5 - offset, 5.0 / 18), {0.5, 8.0 / 18}, {0.5 + offset, 5.0 / 18}}) {
      const double x = std::lerp(layerNodeRoot(c), layerNodeRoot(c + 1), t);
      sum += weight * 4 * x * x * x * std::lerp(a[c], a[c + 1], t) * std::lerp(b[c], b[c + 1], t);
    }
  }
  return sum / (kCount - 1);
}

double mean(const LayerRow& row) {
  LayerRow one;
  one.fill(1);
  return meanOfProduct(row, one);
}

void spread(LayerRow& shares, double mu, double weight) {
  const double position = std::sqrt(std::clamp(mu, 0.0, 1.0)) * (kCount - 1);
  const uint32_t c = std::min(static_cast<uint32_t>(position), kCount - 2);
  shares[c] += weight * (1 - (position - c));
  shares[c + 1] += weight * (position - c);
}

std::array<LayerRow, 2> facetRows(const FacetModel& model, double roughness) {
  static_assert(kCount == gpu::kFacetAlbedoMuCount, "the nodes are shared");
  const double position = roughness * (gpu::kFacetAlbedoRoughnessCount - 1);
  const uint32_t r = std::min(static_cast<uint32_t>(position), gpu::kFacetAlbedoRoughnessCount - 2);
  const std::vector<glm::vec2>& table = facetAlbedoTable(model);
  std::array<LayerRow, 2> rows;
  for (uint32_t c = 0; c < kCount; ++c) {
    const glm::dvec2 low(table[r * kCount + c]);
    const glm::dvec2 high(table[(r + 1) * kCount + c]);
    const glm::dvec2 value = glm::mix(low, high, position - r);
    rows[0][c] = value.x;
    rows[1][c] = value.y;
  }
  return rows;
}

const WhiteBases& whiteBases(const FacetModel& model) {
  static Memo<FacetModel, std::unique_ptr<WhiteBases>> known;
  return *known.get(model, [&] {
    auto bases = std::make_unique<WhiteBases>();
    for (uint32_t b = 1; b < gpu::kLayerBaseCount; ++b) (*bases)[b] = whiteBase(model, layerBaseRoughness(b));
    return bases;
  });
}

// Fixed-point iteration of the symmetric scaling problem (Sinkhorn and Knopp 1967), each step halved in the logarithm.
LayerRow layerCoupling(const WhiteBases& bases, uint32_t b, const LayerRow& passed, const LayerRow& start, int steps) {
  LayerRow g;
  if (b == 0) { // a mirror sends light of mu to mu
    std::transform(passed.begin(), passed.end(), g.begin(), [](double share) { return std::sqrt(share); });
    return g;
  }
  g = start;
  for (int step = 0; step < steps; ++step) {
    LayerRow next;
    for (uint32_t c = 0; c < kCount; ++c) {
      const double passes = received(bases[b].all[c], g);
      next[c] = passes > 0 ? std::sqrt(g[c] * passed[c] / passes) : 0;
    }
    g = next;
  }
  return g;
}

LayerRow layerCoupling(const WhiteBases& bases, uint32_t b, const LayerRow& passed) {
  return layerCoupling(bases, b, passed, layerCoupling(bases, 0, passed, passed, 0), 16);
}

std::array<LayerRow, 2> leavingShares(const WhiteBases& bases, uint32_t b, const LayerRow& passed, const LayerRow& g) {
  if (b == 0) return {passed, passed};
  const WhiteBase& base = bases[b];
  LayerRow one;
  one.fill(1);
  std::array<LayerRow, 2> through;
  for (uint32_t c = 0; c < kCount; ++c) {
    const double grazing = received(base.grazing[c], one), normal = received(base.single[c], one) - grazing;
    const double grazingThrough = received(base.grazing[c], g);
    const double normalThrough = received(base.single[c], g) - grazingThrough;
    through[0][c] = g[c] * (normal > 1e-9 ? normalThrough / normal : grazingThrough / grazing);
    through[1][c] = g[c] * (grazing > 1e-9 ? grazingThrough / grazing : normalThrough / normal);
  }
  return through;
}

} // namespace isophote
