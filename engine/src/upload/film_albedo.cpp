#include "upload/film_albedo.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "shared/bsdf_constants.h"
#include "upload/cosine_mean.hpp"
#include "upload/memo.hpp"
#include "upload/thin_film.hpp"

namespace isophote {
namespace {

constexpr uint32_t kMuCount = gpu::kFilmMuCount;
constexpr uint32_t kCosineCount = 192;
constexpr NormalQuadrature kQuadrature{48, 24, true};

double columnMu(uint32_t column) { return std::pow(column / double(kMuCount - 1), 2); }

/// Of light that one reflection sends out, the shares by the cosine to the facet, at nodes i / (kCosineCount - 1).
using CosineShares = std::array<double, kCosineCount>;

CosineShares cosineShares(const Facets& facets, double mu) {
  const glm::dvec3 wo(std::sqrt(1 - mu * mu), 0, mu);
  const double lengthO = facets.projectedLength(wo);
  CosineShares shares{};
  forVisibleNormals(facets, wo, kQuadrature, [&](const glm::dvec3& wm, double cosine, double weight) {
    const glm::dvec3 wi = 2 * cosine * wm - wo;
    if (wi.z <= 0) return;
    const double position = std::clamp(cosine, 0.0, 1.0) * (kCosineCount - 1);
    const uint32_t i = std::min(static_cast<uint32_t>(position), kCosineCount - 2);
    const double share = weight * facets.passage(wo, lengthO, wi);
    shares[i] += share * (1 - (position - i));
    shares[i + 1] += share * (position - i);
  });
  return shares;
}

void append(std::vector<glm::vec3>& table, const std::array<glm::dvec3, kMuCount>& row) {
  table.insert(table.end(), row.begin(), row.end());
  table.emplace_back(cosineMean(row));
}

uint32_t roughnessCount(const FilmSurface& surface) {
  return surface.roughness.x == surface.roughness.y ? 1 : gpu::kFilmRoughnessCount;
}

uint32_t thicknessCount(const FilmSurface& surface) {
  const float path = 2 * surface.ior * (surface.thickness.y - surface.thickness.x);
  const float steps = std::ceil(path / gpu::kFilmPathStep);
  return static_cast<uint32_t>(std::min(steps, float(gpu::kFilmThicknessLimit - 1))) + 1;
}

double node(const glm::vec2& range, uint32_t i, uint32_t count) {
  return count == 1 ? double(range.y) : std::lerp(double(range.x), double(range.y), i / double(count - 1));
}

std::vector<glm::vec3> computeTable(const FilmSurface& surface, const FacetModel& model) {
  const uint32_t roughnesses = roughnessCount(surface), thicknesses = thicknessCount(surface);
  const glm::dvec3 f0(surface.f0);
  const double ior = double(surface.ior);
  std::vector<std::array<glm::dvec3, kCosineCount>> films(thicknesses);
  for (uint32_t t = 0; t < thicknesses; ++t) {
    for (uint32_t i = 0; i < kCosineCount; ++i) {
      films[t][i] = thinFilmReflectance(ior, node(surface.thickness, t, thicknesses), i / double(kCosineCount - 1), f0);
    }
  }
  std::vector<glm::vec3> table{glm::vec3(surface.thickness, thicknesses), glm::vec3(surface.roughness, roughnesses)};
  for (uint32_t r = 0; r < roughnesses; ++r) {
    const double alpha = std::pow(node(surface.roughness, r, roughnesses), 2);
    const bool mirror = alpha < double(gpu::kMirrorAlpha);
    std::vector<CosineShares> shares;
    for (uint32_t c = 0; c < kMuCount && !mirror; ++c)
      shares.push_back(cosineShares(Facets(model, glm::dvec2(alpha)), columnMu(c)));
    for (uint32_t t = 0; t < thicknesses; ++t) {
      std::array<glm::dvec3, kMuCount> row{};
      for (uint32_t c = 0; c < kMuCount; ++c) {
        if (mirror) row[c] = thinFilmReflectance(ior, node(surface.thickness, t, thicknesses), columnMu(c), f0);
        for (uint32_t i = 0; i < kCosineCount && !mirror; ++i) row[c] += shares[c][i] * films[t][i];
      }
      append(table, row);
    }
  }
  return table;
}

} // namespace

uint32_t filmAlbedoSize(const FilmSurface& surface) {
  return gpu::kFilmHeader + roughnessCount(surface) * thicknessCount(surface) * gpu::kFilmPlane;
}

const std::vector<glm::vec3>& filmAlbedoTable(const FilmSurface& surface, const FacetModel& model) {
  static Memo<std::tuple<float, float, float, float, float, float, float, float, FacetModel>, std::vector<glm::vec3>>
      tables;
  return tables.get({surface.f0.x, surface.f0.y, surface.f0.z, surface.ior, surface.thickness.x, surface.thickness.y,
                     surface.roughness.x, surface.roughness.y, model},
                    [&] { return computeTable(surface, model); });
}

} // namespace isophote
