#include "upload/facet_albedo.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "shared/bsdf_constants.h"
#include "upload/cosine_mean.hpp"
#include "upload/dielectric.hpp"
#include "upload/memo.hpp"

namespace isophote {
namespace {

// Midpoints per integral; docs/bsdf.md gives the error that this and the table's spacing leave.
constexpr int kHeightCount = 48;
constexpr int kAzimuthCount = 24; // over half a turn: the integrand is symmetric

double pow5(double x) { return x * x * x * x * x; }

/// How far the reflectance at a cosine has come from f0 to f90.
double grazingShare(double cosine, double exactIor) {
  if (exactIor < 1) return pow5(1 - cosine);
  const double normal = (exactIor - 1) / (exactIor + 1);
  return (dielectricReflectance(cosine, exactIor) - normal * normal) / (1 - normal * normal);
}

/// (A, B) at one point.
glm::dvec2 directionalAlbedo(const Facets& facets, double mu, double exactIor) {
  const glm::dvec3 wo(std::sqrt(1 - mu * mu), 0, mu);
  const double lengthO = facets.projectedLength(wo);
  glm::dvec2 sum(0);
  forVisibleNormals(facets, wo, {kHeightCount, kAzimuthCount, true},
                    [&](const glm::dvec3& wm, double cosine, double weight) {
                      const glm::dvec3 wi = 2 * cosine * wm - wo;
                      if (wi.z <= 0) return;
                      const double grazing = grazingShare(cosine, exactIor);
                      sum += weight * facets.passage(wo, lengthO, wi) * glm::dvec2(1 - grazing, grazing);
                    });
  return sum;
}

double columnMu(uint32_t column) {
  const double root = column / double(gpu::kFacetAlbedoMuCount - 1);
  return root * root;
}

std::vector<glm::vec2> computeTable(const FacetModel& model, double exactIor) {
  std::vector<glm::vec2> table;
  std::vector<glm::vec2> means;
  table.reserve(gpu::kFacetAlbedoSize);
  for (uint32_t r = 0; r < gpu::kFacetAlbedoRoughnessCount; ++r) {
    const double roughness = r / double(gpu::kFacetAlbedoRoughnessCount - 1);
    std::array<glm::dvec2, gpu::kFacetAlbedoMuCount> row;
    for (uint32_t c = 0; c < gpu::kFacetAlbedoMuCount; ++c) {
      const double mu = columnMu(c);
      const double mirror = grazingShare(mu, exactIor);
      row[c] = r == 0 ? glm::dvec2(1 - mirror, mirror)
                      : directionalAlbedo(Facets(model, glm::dvec2(roughness * roughness)), mu, exactIor);
      table.emplace_back(row[c]);
    }
    means.emplace_back(cosineMean(row));
  }
  table.insert(table.end(), means.begin(), means.end());
  return table;
}

} // namespace

const std::vector<glm::vec2>& facetAlbedoTable(const FacetModel& model) {
  static Memo<FacetModel, std::vector<glm::vec2>> tables;
  return tables.get(model, [&] { return computeTable(model, 0); });
}

const std::vector<glm::vec2>& exactAlbedoTable(const FacetModel& model, float ior) {
  if (ior < 1) return facetAlbedoTable(model);
  static Memo<std::pair<FacetModel, float>, std::vector<glm::vec2>> tables;
  return tables.get({model, ior}, [&] { return computeTable(model, double(ior)); });
}

} // namespace isophote
