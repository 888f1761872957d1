#include "upload/ggx_albedo.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "shared/bsdf_constants.h"
#include "upload/cosine_mean.hpp"

namespace isophote {
namespace {

// Midpoints per integral; docs/bsdf.md gives the error that this and the table's spacing leave.
constexpr int kHeightCount = 48;
constexpr int kAzimuthCount = 24; // over half a turn: the integrand is symmetric

double pow5(double x) { return x * x * x * x * x; }

std::array<glm::dvec2, kAzimuthCount> azimuths() {
  std::array<glm::dvec2, kAzimuthCount> result;
  for (int j = 0; j < kAzimuthCount; ++j) {
    const double phi = std::numbers::pi * (j + 0.5) / kAzimuthCount;
    result[static_cast<size_t>(j)] = {std::cos(phi), std::sin(phi)};
  }
  return result;
}

/// (A, B) at one point: the mean of G2 / G1 times the Fresnel weights over visible normals, which spherical caps turn
/// into uniform numbers (Dupuy and Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps").
glm::dvec2 directionalAlbedo(double mu, double alpha) {
  static const std::array<glm::dvec2, kAzimuthCount> directions = azimuths();
  const glm::dvec3 wo(std::sqrt(1 - mu * mu), 0, mu);
  const glm::dvec3 view = glm::normalize(glm::dvec3(alpha * wo.x, 0, wo.z));
  const auto projectedLength = [alpha](double z) { return std::sqrt(alpha * alpha * (1 - z * z) + z * z); };
  const double lengthO = projectedLength(mu);
  glm::dvec2 sum(0);
  for (int i = 0; i < kHeightCount; ++i) {
    // Quadratic in t: nodes crowd at flat normals, where wi sinks below the horizon.
    const double t = (i + 0.5) / kHeightCount;
    const double height = t * t * (1 + view.z); // above the cap's rim at z = -view.z
    const double z = height - view.z;
    const double radius = std::sqrt(std::max(0.0, 1 - z * z));
    for (const glm::dvec2& direction : directions) {
      const glm::dvec3 wm =
          glm::normalize(glm::dvec3(alpha * (radius * direction.x + view.x), alpha * radius * direction.y, height));
      const double cosine = wo.x * wm.x + wo.z * wm.z;
      const double wiZ = 2 * cosine * wm.z - wo.z;
      if (wiZ <= 0) continue;
      const double weight = 2 * t * wiZ * (mu + lengthO) / (mu * projectedLength(wiZ) + wiZ * lengthO); // G2 / G1 dt
      const double grazing = pow5(1 - std::min(cosine, 1.0));
      sum += weight * glm::dvec2(1 - grazing, grazing);
    }
  }
  return sum / double(kHeightCount * kAzimuthCount);
}

double columnMu(uint32_t column) {
  const double root = column / double(gpu::kGgxAlbedoMuCount - 1);
  return root * root;
}

std::vector<glm::vec2> computeTable() {
  std::vector<glm::vec2> table;
  std::vector<glm::vec2> means;
  table.reserve(gpu::kGgxAlbedoMeans + gpu::kGgxAlbedoRoughnessCount);
  for (uint32_t r = 0; r < gpu::kGgxAlbedoRoughnessCount; ++r) {
    const double roughness = r / double(gpu::kGgxAlbedoRoughnessCount - 1);
    std::array<glm::dvec2, gpu::kGgxAlbedoMuCount> row;
    for (uint32_t c = 0; c < gpu::kGgxAlbedoMuCount; ++c) {
      const double mu = columnMu(c);
      row[c] = r == 0 ? glm::dvec2(1 - pow5(1 - mu), pow5(1 - mu)) : directionalAlbedo(mu, roughness * roughness);
      table.emplace_back(row[c]);
    }
    means.emplace_back(cosineMean(row));
  }
  table.insert(table.end(), means.begin(), means.end());
  return table;
}

} // namespace

const std::vector<glm::vec2>& ggxAlbedoTable() {
  static const std::vector<glm::vec2> table = computeTable();
  return table;
}

} // namespace isophote
