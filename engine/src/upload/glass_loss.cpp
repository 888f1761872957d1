#include "upload/glass_loss.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <future>
#include <tuple>

#include "shared/bsdf_constants.h"
#include "upload/cosine_mean.hpp"
#include "upload/dielectric.hpp"
#include "upload/memo.hpp"

namespace isophote {
namespace {

// Midpoints per integral; docs/bsdf.md gives the error that this and the table's spacing leave.
constexpr int kHeightCount = 64;
constexpr int kAzimuthCount = 24; // over half a turn: the integrand is symmetric

double square(double x) { return x * x; }

/// 1 minus what leaves to either side after one scattering.
glm::dvec2 directionalLoss(const Facets& facets, double mu, double eta, bool bySchlick) {
  const glm::dvec3 wo(std::sqrt(1 - mu * mu), 0, mu);
  const double lengthO = facets.projectedLength(wo);
  const auto kept = [&](const glm::dvec3& wi, bool below) {
    return (below ? -wi.z : wi.z) > 0 ? facets.passage(wo, lengthO, wi) : 0.0;
  };
  glm::dvec2 sum(0);
  forVisibleNormals(
      facets, wo, {kHeightCount, kAzimuthCount, true}, [&](const glm::dvec3& wm, double cosine, double weight) {
        const double reflected = kept(2 * cosine * wm - wo, false);
        const double squaredCosT = 1 - (1 - square(cosine)) / square(eta);
        if (squaredCosT <= 0) {
          sum += weight * glm::dvec2(reflected);
          return;
        }
        const double transmitted = kept((cosine / eta - std::sqrt(squaredCosT)) * wm - wo / eta, true);
        const double reflectance = bySchlick ? schlickReflectance(cosine, eta) : dielectricReflectance(cosine, eta);
        sum += weight * glm::dvec2(std::lerp(transmitted, reflected, reflectance), transmitted);
      });
  return glm::max(1.0 - sum, 0.0);
}

/// One half of a table: from the side whose other side has the index eta, relative.
std::vector<glm::vec2> lossFrom(double eta, const GlassSurface& glass, const GlassModel& model) {
  std::vector<glm::vec2> values;
  std::vector<glm::vec2> means;
  for (uint32_t r = 0; r < gpu::kGlassLossRoughnessCount; ++r) {
    constexpr double kSpacing = 1.0 / (gpu::kGlassLossRoughnessCount - 1);
    const double roughness = r * kSpacing;
    const bool skipped =
        r == 0 || roughness < double(glass.roughness.x) - kSpacing || roughness > double(glass.roughness.y) + kSpacing;
    const Facets facets(model.facets, glm::dvec2(std::max(square(roughness), double(gpu::kNarrowestAlpha))));
    std::array<glm::dvec2, gpu::kGlassLossMuCount> row;
    for (uint32_t c = 0; c < gpu::kGlassLossMuCount; ++c) {
      const double mu = square(c / double(gpu::kGlassLossMuCount - 1));
      row[c] = skipped ? glm::dvec2(0) : directionalLoss(facets, mu, eta, model.bySchlick);
      values.emplace_back(row[c]);
    }
    means.emplace_back(cosineMean(row));
  }
  values.insert(values.end(), means.begin(), means.end());
  return values;
}

std::vector<glm::vec2> computeTable(const GlassSurface& glass, const GlassModel& model) {
  const double index = std::clamp(double(glass.ior), 1.0, 1024.0);
  auto inside = std::async(std::launch::async, [&] { return lossFrom(1 / index, glass, model); });
  std::vector<glm::vec2> table = lossFrom(index, glass, model);
  const std::vector<glm::vec2> half = inside.get();
  table.insert(table.end(), half.begin(), half.end());
  return table;
}

} // namespace

const std::vector<glm::vec2>& glassLossTable(const GlassSurface& glass, const GlassModel& model) {
  static Memo<std::tuple<float, float, float, FacetModel, bool>, std::vector<glm::vec2>> tables;
  return tables.get({glass.ior, glass.roughness.x, glass.roughness.y, model.facets, model.bySchlick},
                    [&] { return computeTable(glass, model); });
}

} // namespace isophote
