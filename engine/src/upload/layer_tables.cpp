#include "upload/layer_tables.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include <glm/glm.hpp>

#include "shared/bsdf_constants.h"
#include "upload/facet_albedo.hpp"
#include "upload/memo.hpp"

namespace isophote {
namespace {

constexpr uint32_t kMuCount = gpu::kLayerMuCount;

/// One function of mu at the nodes mu = (c / (kMuCount - 1))^2, linear in sqrt(mu) between, as the device reads it.
using Row = std::array<double, kMuCount>;

double nodeRoot(uint32_t column) { return column / double(kMuCount - 1); }

/// Cosine-weighted mean of a product of two rows over the hemisphere: with x = sqrt(mu), 2 mu dmu = 4 x^3 dx. Three
/// Gauss-Legendre nodes an interval are exact for x^3 times a product of linear functions.
double meanOfProduct(const Row& a, const Row& b) {
  const double offset = std::sqrt(0.6) / 2;
  double sum = 0;
  for (uint32_t c = 0; c + 1 < kMuCount; ++c) {
    for (const auto& [t, weight] : {std::pair(0.5 - offset, 5.0 / 18), {0.5, 8.0 / 18}, {0.5 + offset, 5.0 / 18}}) {
      const double x = std::lerp(nodeRoot(c), nodeRoot(c + 1), t);
      sum += weight * 4 * x * x * x * std::lerp(a[c], a[c + 1], t) * std::lerp(b[c], b[c + 1], t);
    }
  }
  return sum / (kMuCount - 1);
}

double mean(const Row& row) {
  Row one;
  one.fill(1);
  return meanOfProduct(row, one);
}

/// (A, B) of GGX at one roughness, from the device's own table.
std::array<Row, 2> facetRows(const FacetModel& model, double roughness) {
  static_assert(kMuCount == gpu::kFacetAlbedoMuCount, "the nodes are shared");
  const double position = roughness * (gpu::kFacetAlbedoRoughnessCount - 1);
  const uint32_t r = std::min(static_cast<uint32_t>(position), gpu::kFacetAlbedoRoughnessCount - 2);
  const std::vector<glm::vec2>& table = facetAlbedoTable(model);
  std::array<Row, 2> rows;
  for (uint32_t c = 0; c < kMuCount; ++c) {
    const glm::dvec2 low(table[r * kMuCount + c]);
    const glm::dvec2 high(table[(r + 1) * kMuCount + c]);
    const glm::dvec2 value = glm::mix(low, high, position - r);
    rows[0][c] = value.x;
    rows[1][c] = value.y;
  }
  return rows;
}

double baseRoughness(uint32_t b) { return b / double(gpu::kLayerBaseCount - 1); }
double layerRow(uint32_t r) { return r / double(gpu::kLayerRoughnessCount - 1); }

// ---- A white microfacet base: where it sends light, by cosines alone. ----

/// Row c: the share of light of node c that node k receives.
using Transport = std::array<Row, kMuCount>;

struct WhiteBase {
  Transport all;     ///< rows sum to 1
  Transport single;  ///< by one reflection at a facet
  Transport grazing; ///< the part of that which Schlick's approximation weighs by f90
};

void spread(Row& shares, double mu, double weight) {
  const double position = std::sqrt(std::clamp(mu, 0.0, 1.0)) * (kMuCount - 1);
  const uint32_t c = std::min(static_cast<uint32_t>(position), kMuCount - 2);
  shares[c] += weight * (1 - (position - c));
  shares[c + 1] += weight * (position - c);
}

/// One row by visible normals, as in facet_albedo.cpp.
void addReflectedShares(const Facets& facets, double mu, Row& shares, Row& grazing) {
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
  Transport& transport = base.all;
  Row lost{};
  for (uint32_t c = 0; c < kMuCount; ++c) {
    addReflectedShares(facets, nodeRoot(c) * nodeRoot(c), base.single[c], base.grazing[c]);
    transport[c] = base.single[c];
    double sum = 0;
    for (const double share : transport[c]) sum += share;
    lost[c] = std::max(1 - sum, 0.0);
  }
  Row returned{};
  for (uint32_t c = 0; c + 1 < kMuCount; ++c) { // the cosine's own shares of the nodes, weighed by what they lose
    constexpr int kSteps = 8;
    for (int i = 0; i < kSteps; ++i) {
      const double t = (i + 0.5) / kSteps;
      const double x = std::lerp(nodeRoot(c), nodeRoot(c + 1), t);
      spread(returned, x * x, 4 * x * x * x * std::lerp(lost[c], lost[c + 1], t));
    }
  }
  double total = 0;
  for (const double share : returned) total += share;
  for (uint32_t c = 0; c < kMuCount; ++c) {
    double sum = 0;
    for (uint32_t k = 0; k < kMuCount; ++k) sum += transport[c][k] += total > 0 ? lost[c] * returned[k] / total : 0;
    for (double& share : transport[c]) share /= sum;
  }
  return base;
}

/// The function g with g(mu) * (mean of g where the base sends light of mu) = passed(mu), by fixed-point iteration of
/// the symmetric scaling problem (Sinkhorn and Knopp 1967), each step halved in the logarithm.
Row symmetricScaling(const Transport& transport, const Row& passed) {
  constexpr int kSteps = 16;
  Row g;
  for (uint32_t c = 0; c < kMuCount; ++c) g[c] = std::sqrt(passed[c]);
  for (int step = 0; step < kSteps; ++step) {
    Row next;
    for (uint32_t c = 0; c < kMuCount; ++c) {
      double received = 0;
      for (uint32_t k = 0; k < kMuCount; ++k) received += transport[c][k] * g[k];
      next[c] = received > 0 ? std::sqrt(g[c] * passed[c] / received) : 0;
    }
    g = next;
  }
  return g;
}

double received(const Row& shares, const Row& g) {
  double sum = 0;
  for (uint32_t k = 0; k < kMuCount; ++k) sum += shares[k] * g[k];
  return sum;
}

/// The shares of the facets' albedo, by Schlick's weights A and B, that leave a layer of coupling g.
std::array<Row, 2> leavingShares(const WhiteBase& base, const Row& g) {
  Row one;
  one.fill(1);
  std::array<Row, 2> through;
  for (uint32_t c = 0; c < kMuCount; ++c) {
    const double grazing = received(base.grazing[c], one), normal = received(base.single[c], one) - grazing;
    const double grazingThrough = received(base.grazing[c], g);
    const double normalThrough = received(base.single[c], g) - grazingThrough;
    through[0][c] = g[c] * (normal > 1e-9 ? normalThrough / normal : grazingThrough / grazing);
    through[1][c] = g[c] * (grazing > 1e-9 ? grazingThrough / grazing : normalThrough / normal);
  }
  return through;
}

// ---- Layers ----

struct LayerAlbedo {
  Row albedo; ///< of the lobe as it is evaluated
  Row scale;  ///< of the lobe, at wo and at wi
};

/// @param layerAlbedo of a row
std::vector<float> computeTable(const FacetModel& model, const std::function<LayerAlbedo(uint32_t)>& layerAlbedo) {
  std::vector<float> table(gpu::kLayerTableSize);
  std::vector<WhiteBase> bases(gpu::kLayerBaseCount);
  for (uint32_t b = 1; b < gpu::kLayerBaseCount; ++b) bases[b] = whiteBase(model, baseRoughness(b));
  for (uint32_t r = 0; r < gpu::kLayerRoughnessCount; ++r) {
    const LayerAlbedo layer = layerAlbedo(r);
    std::copy(layer.albedo.begin(), layer.albedo.end(), &table[gpu::kLayerAlbedo + r * kMuCount]);
    std::copy(layer.scale.begin(), layer.scale.end(), &table[gpu::kLayerScale + r * kMuCount]);
    const double layerMean = mean(layer.albedo);
    table[gpu::kLayerMean + r] = static_cast<float>(layerMean);
    Row passed;
    for (uint32_t c = 0; c < kMuCount; ++c) passed[c] = std::max(1 - layer.albedo[c], 0.0);
    for (uint32_t b = 0; b < gpu::kLayerBaseCount; ++b) {
      const uint32_t cell = r * gpu::kLayerBaseCount + b;
      const std::array<Row, 2> ggx = facetRows(model, baseRoughness(b));
      for (uint32_t i = 0; i < 2; ++i) {
        table[gpu::kLayerCovariance + 2 * cell + i] =
            static_cast<float>(meanOfProduct(ggx[i], layer.albedo) - mean(ggx[i]) * layerMean);
      }
      Row g;
      std::array<Row, 2> through{passed, passed};
      if (b > 0) {
        g = symmetricScaling(bases[b].all, passed);
        through = leavingShares(bases[b], g);
      } else { // a mirror sends light of mu to mu
        std::transform(passed.begin(), passed.end(), g.begin(), [](double share) { return std::sqrt(share); });
      }
      std::copy(g.begin(), g.end(), &table[gpu::kLayerNarrow + cell * kMuCount]);
      for (uint32_t i = 0; i < 2; ++i) {
        std::copy(through[i].begin(), through[i].end(),
                  &table[gpu::kLayerThrough + i * gpu::kLayerThroughStride + cell * kMuCount]);
        table[gpu::kLayerThroughMean + 2 * cell + i] = static_cast<float>(meanOfProduct(ggx[i], through[i]));
      }
    }
  }
  return table;
}

LayerAlbedo clearcoatAlbedo(const FacetModel& model, double roughness) {
  const std::array<Row, 2> ggx = facetRows(model, roughness);
  LayerAlbedo layer;
  layer.scale.fill(1);
  for (uint32_t c = 0; c < kMuCount; ++c) layer.albedo[c] = double(gpu::kClearcoatF0) * ggx[0][c] + ggx[1][c];
  return layer;
}

// ---- Sheen: the formulas of shaders/bsdf/sheen.glsl in double precision. ----

double sheenLambda(double cosine, double alpha) {
  const double t = (1 - alpha) * (1 - alpha);
  const auto fit = [t](double atOne, double atZero) { return std::lerp(atOne, atZero, t); };
  const double a = fit(21.5473, 25.3245), b = fit(3.82987, 3.32435), c = fit(0.19823, 0.16801);
  const double d = fit(-1.97760, -1.27393), e = fit(-4.32054, -4.85967);
  const auto curve = [&](double x) { return a / (1 + b * std::pow(x, c)) + d * x + e; };
  return std::exp(cosine < 0.5 ? curve(cosine) : 2 * curve(0.5) - curve(1 - cosine));
}

/// Shares of the sheen's albedo by the node they go to, before scaling.
Row sheenShares(double mu, double alpha, const std::vector<double>& lambdas) {
  const int heights = static_cast<int>(lambdas.size());
  constexpr int kAzimuthCount = 32;
  const double sine = std::sqrt(1 - mu * mu);
  const double lambdaO = sheenLambda(mu, alpha);
  Row shares{};
  for (int i = 0; i < heights; ++i) {
    const double t = (i + 0.5) / heights;
    const double muI = t * t * t; // grazing directions carry most
    const double sineI = std::sqrt(1 - muI * muI);
    double sum = 0;
    for (int j = 0; j < kAzimuthCount; ++j) {
      const double phi = std::numbers::pi * (j + 0.5) / kAzimuthCount;
      const glm::dvec3 h(sine + sineI * std::cos(phi), sineI * std::sin(phi), mu + muI);
      const double sin2 = (h.x * h.x + h.y * h.y) / glm::dot(h, h);
      sum += std::pow(sin2, 0.5 / alpha);
    }
    const double distribution = (2 + 1 / alpha) / (2 * std::numbers::pi) * sum / kAzimuthCount;
    // D / (4 mu (1 + Lambda + Lambda)), over the azimuths of both halves and dmuI = 3 t^2 dt.
    const double value = distribution / (4 * std::max(mu, 1e-4) * (1 + lambdaO + lambdas[static_cast<size_t>(i)]));
    spread(shares, muI, 2 * std::numbers::pi * value * 3 * t * t / heights);
  }
  return shares;
}

/// The roughness of a row: sheenRow of shaders/bsdf/sheen.glsl, turned round.
double sheenRoughness(uint32_t r) {
  const double least = std::sqrt(double(gpu::kMinSheenAlpha));
  return least + (1 - least) * layerRow(r) * layerRow(r);
}

struct SheenLobe {
  LayerAlbedo layer;
  std::array<Row, kMuCount> shares; ///< of light of one node that go to another
};

/// Near grazing the published lobe reflects more than arrives where roughness is below 0.3. It is divided by its own
/// albedo there, at both directions, so that it stays reciprocal and never exceeds 1.
SheenLobe sheenLobe(double roughness) {
  constexpr int kHeightCount = 48;
  const double alpha = std::max(roughness * roughness, double(gpu::kMinSheenAlpha));
  std::vector<double> lambdas;
  for (int i = 0; i < kHeightCount; ++i) {
    const double t = (i + 0.5) / kHeightCount;
    lambdas.push_back(sheenLambda(t * t * t, alpha));
  }
  SheenLobe lobe;
  auto& [layer, shares] = lobe;
  for (uint32_t c = 0; c < kMuCount; ++c) {
    shares[c] = sheenShares(nodeRoot(c) * nodeRoot(c), alpha, lambdas);
    double sum = 0;
    for (const double share : shares[c]) sum += share;
    layer.scale[c] = 1 / std::max(sum, 1.0);
  }
  for (uint32_t c = 0; c < kMuCount; ++c) {
    double sum = 0;
    for (uint32_t k = 0; k < kMuCount; ++k) sum += shares[c][k] *= layer.scale[c] * layer.scale[k];
    layer.albedo[c] = std::min(sum, 1.0);
  }
  return lobe;
}

/// What a clearcoat above takes from the sheen's light: the larger of its albedos at both directions.
void addCoatedSheen(const FacetModel& model, const std::vector<SheenLobe>& lobes, std::vector<float>& table) {
  table.resize(gpu::kSheenTableSize);
  std::array<std::array<Row, 2>, gpu::kLayerBaseCount> ggx;
  for (uint32_t b = 0; b < gpu::kLayerBaseCount; ++b) ggx[b] = facetRows(model, baseRoughness(b));
  for (uint32_t q = 0; q < gpu::kLayerBaseCount; ++q) {
    const Row coat = clearcoatAlbedo(model, baseRoughness(q)).albedo;
    for (uint32_t r = 0; r < gpu::kLayerRoughnessCount; ++r) {
      Row taken{};
      for (uint32_t c = 0; c < kMuCount; ++c) {
        for (uint32_t k = 0; k < kMuCount; ++k) taken[c] += lobes[r].shares[c][k] * std::max(coat[c], coat[k]);
      }
      const uint32_t pair = r * gpu::kLayerBaseCount + q;
      std::copy(taken.begin(), taken.end(), &table[gpu::kCoatedSheen + pair * kMuCount]);
      const double takenMean = mean(taken);
      table[gpu::kCoatedSheenMean + pair] = static_cast<float>(takenMean);
      for (uint32_t b = 0; b < gpu::kLayerBaseCount; ++b) {
        for (uint32_t i = 0; i < 2; ++i) {
          table[gpu::kCoatedSheenCovariance + 2 * (pair * gpu::kLayerBaseCount + b) + i] =
              static_cast<float>(meanOfProduct(ggx[b][i], taken) - mean(ggx[b][i]) * takenMean);
        }
      }
    }
  }
}

std::vector<float> computeSheenTable(const FacetModel& model) {
  std::vector<SheenLobe> lobes;
  for (uint32_t r = 0; r < gpu::kLayerRoughnessCount; ++r) lobes.push_back(sheenLobe(sheenRoughness(r)));
  std::vector<float> table = computeTable(model, [&lobes](uint32_t r) { return lobes[r].layer; });
  addCoatedSheen(model, lobes, table);
  return table;
}

} // namespace

const std::vector<float>& clearcoatTable(const FacetModel& model) {
  static Memo<FacetModel, std::vector<float>> tables;
  const auto albedo = [&](uint32_t r) { return clearcoatAlbedo(model, layerRow(r)); };
  return tables.get(model, [&] { return computeTable(model, albedo); });
}

const std::vector<float>& sheenTable(const FacetModel& model) {
  static Memo<FacetModel, std::vector<float>> tables;
  return tables.get(model, [&] { return computeSheenTable(model); });
}

} // namespace isophote
