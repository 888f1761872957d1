#include "upload/anisotropic_albedo.hpp"

#include <algorithm>
#include <array>
#include <future>
#include <tuple>

#include "shared/bsdf_constants.h"
#include "upload/cosine_mean.hpp"
#include "upload/memo.hpp"

namespace isophote {
namespace {

constexpr uint32_t kMuCount = gpu::kAnisotropyMuCount;
constexpr uint32_t kAzimuthCount = gpu::kAnisotropyAzimuthCount;
constexpr NormalQuadrature kQuadrature{24, 24, false};

/// One row of a plane: (A, B) at mu = (c / (kMuCount - 1))^2.
using Row = std::array<glm::dvec2, kMuCount>;

glm::dvec2 directionalAlbedo(const Facets& facets, const glm::dvec3& wo) {
  const double lengthO = facets.projectedLength(wo);
  glm::dvec2 sum(0);
  forVisibleNormals(facets, wo, kQuadrature, [&](const glm::dvec3& wm, double cosine, double weight) {
    const glm::dvec3 wi = 2 * cosine * wm - wo;
    if (wi.z <= 0) return;
    const double x = 1 - cosine;
    const double grazing = x * x * x * x * x;
    sum += weight * facets.passage(wo, lengthO, wi) * glm::dvec2(1 - grazing, grazing);
  });
  return sum;
}

/// Squared cosine of the azimuth at which facets look `seen` wide.
double squaredCosine(const glm::dvec2& width, double seen) {
  const double range = width.x * width.x - width.y * width.y;
  return range > 0 ? std::clamp((seen * seen - width.y * width.y) / range, 0.0, 1.0) : 1.0;
}

/// Where the azimuth lies among the rows, as the device has it.
double rowPosition(const glm::dvec2& width, double phi) {
  const glm::dvec2 root = glm::sqrt(width);
  if (root.x <= root.y) return 0;
  const double seen = std::sqrt(glm::length(width * glm::dvec2(std::cos(phi), std::sin(phi))));
  return std::clamp((seen - root.y) / (root.x - root.y), 0.0, 1.0) * (kAzimuthCount - 1);
}

/// Mean over azimuths of what the device reads between the rows.
Row azimuthMean(const std::array<Row, kAzimuthCount>& rows, const glm::dvec2& width) {
  constexpr int kSteps = 256; // of a quarter turn
  Row mean{};
  for (int i = 0; i < kSteps; ++i) {
    const double position = rowPosition(width, std::numbers::pi / 2 * (i + 0.5) / kSteps);
    const uint32_t low = std::min(static_cast<uint32_t>(position), kAzimuthCount - 2);
    for (uint32_t c = 0; c < kMuCount; ++c) {
      mean[c] += glm::mix(rows[low][c], rows[low + 1][c], position - low) / double(kSteps);
    }
  }
  return mean;
}

std::vector<glm::vec2> plane(const FacetModel& model, double roughness, double strength) {
  const glm::dvec2 width = anisotropicWidth(roughness, strength);
  const Facets facets(model, width);
  const glm::dvec2 root = glm::sqrt(width);
  std::array<Row, kAzimuthCount> rows;
  std::vector<glm::vec2> values;
  for (uint32_t a = 0; a < kAzimuthCount; ++a) {
    const double seen = std::lerp(root.y, root.x, a / double(kAzimuthCount - 1));
    const double cosine = std::sqrt(squaredCosine(width, seen * seen));
    const double sine = std::sqrt(1 - cosine * cosine);
    for (uint32_t c = 0; c < kMuCount; ++c) {
      const double mu = std::pow(c / double(kMuCount - 1), 2);
      const double across = std::sqrt(1 - mu * mu);
      rows[a][c] = directionalAlbedo(facets, {across * cosine, across * sine, mu});
      values.emplace_back(rows[a][c]);
    }
  }
  values.emplace_back(cosineMean(azimuthMean(rows, width)));
  return values;
}

uint32_t nodeCount(const glm::vec2& range, uint32_t most) { return range.x == range.y ? 1 : most; }

double node(const glm::vec2& range, uint32_t i, uint32_t count) {
  return count == 1 ? double(range.x) : std::lerp(double(range.x), double(range.y), i / double(count - 1));
}

std::vector<glm::vec2> computeTable(const AnisotropicSurface& surface, const FacetModel& model) {
  const uint32_t roughnesses = nodeCount(surface.roughness, gpu::kAnisotropyRoughnessCount);
  const uint32_t strengths = nodeCount(surface.strength, gpu::kAnisotropyStrengthCount);
  std::vector<std::future<std::vector<glm::vec2>>> rows;
  for (uint32_t s = 0; s < strengths; ++s) {
    rows.push_back(std::async(std::launch::async, [&surface, &model, roughnesses, strengths, s] {
      std::vector<glm::vec2> values;
      for (uint32_t r = 0; r < roughnesses; ++r) {
        const std::vector<glm::vec2> more =
            plane(model, node(surface.roughness, r, roughnesses), node(surface.strength, s, strengths));
        values.insert(values.end(), more.begin(), more.end());
      }
      return values;
    }));
  }
  std::vector<glm::vec2> table{surface.roughness, surface.strength};
  for (auto& row : rows) {
    const std::vector<glm::vec2> values = row.get();
    table.insert(table.end(), values.begin(), values.end());
  }
  return table;
}

} // namespace

glm::dvec2 anisotropicWidth(double roughness, double strength) {
  const double alpha = roughness * roughness;
  return glm::max(glm::dvec2(std::lerp(alpha, 1.0, strength * strength), alpha),
                  glm::dvec2(double(gpu::kNarrowestAlpha)));
}

uint32_t anisotropicAlbedoSize(const AnisotropicSurface& surface) {
  return gpu::kAnisotropyHeader + nodeCount(surface.roughness, gpu::kAnisotropyRoughnessCount) *
                                      nodeCount(surface.strength, gpu::kAnisotropyStrengthCount) *
                                      gpu::kAnisotropyPlane;
}

const std::vector<glm::vec2>& anisotropicAlbedoTable(const AnisotropicSurface& surface, const FacetModel& model) {
  static Memo<std::tuple<float, float, float, float, FacetModel>, std::vector<glm::vec2>> tables;
  return tables.get({surface.roughness.x, surface.roughness.y, surface.strength.x, surface.strength.y, model},
                    [&] { return computeTable(surface, model); });
}

} // namespace isophote
