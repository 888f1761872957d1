#include "upload/glass_loss.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <future>
#include <numbers>

#include "shared/bsdf_constants.h"
#include "upload/cosine_mean.hpp"

namespace isophote {
namespace {

// Midpoints per integral; docs/bsdf.md gives the error that this and the table's spacing leave.
constexpr int kHeightCount = 64;
constexpr int kAzimuthCount = 24; // over half a turn: the integrand is symmetric

double square(double x) { return x * x; }

/// Reflectance by the Fresnel equations, cosT the refracted cosine. Source: Born and Wolf 1999, section 1.5.2, eq. 21.
double fresnel(double cosI, double cosT, double eta) {
  const double s = (cosI - eta * cosT) / (cosI + eta * cosT);
  const double p = (eta * cosI - cosT) / (eta * cosI + cosT);
  return 0.5 * (s * s + p * p);
}

std::array<glm::dvec2, kAzimuthCount> azimuths() {
  std::array<glm::dvec2, kAzimuthCount> result;
  for (int j = 0; j < kAzimuthCount; ++j) {
    const double phi = std::numbers::pi * (j + 0.5) / kAzimuthCount;
    result[static_cast<size_t>(j)] = {std::cos(phi), std::sin(phi)};
  }
  return result;
}

/// 1 minus the mean over visible normals of what leaves to either side, as ggx_albedo.cpp integrates reflection.
glm::dvec2 directionalLoss(double mu, double alpha, double eta) {
  static const std::array<glm::dvec2, kAzimuthCount> directions = azimuths();
  const glm::dvec3 wo(std::sqrt(1 - mu * mu), 0, mu);
  const glm::dvec3 view = glm::normalize(glm::dvec3(alpha * wo.x, 0, wo.z));
  const auto projectedLength = [alpha](double z) { return std::sqrt(alpha * alpha * (1 - z * z) + z * z); };
  const double lengthO = projectedLength(mu);
  const auto kept = [&](double z) { // G2 / G1 of light that leaves at cosine z to the side it should
    return z > 0 ? z * (mu + lengthO) / (mu * projectedLength(z) + z * lengthO) : 0.0;
  };
  glm::dvec2 sum(0);
  for (int i = 0; i < kHeightCount; ++i) {
    const double t = (i + 0.5) / kHeightCount;
    const double height = t * t * (1 + view.z);
    const double z = height - view.z;
    const double radius = std::sqrt(std::max(0.0, 1 - z * z));
    for (const glm::dvec2& direction : directions) {
      const glm::dvec3 wm =
          glm::normalize(glm::dvec3(alpha * (radius * direction.x + view.x), alpha * radius * direction.y, height));
      const double cosine = std::min(wo.x * wm.x + wo.z * wm.z, 1.0);
      const double reflected = kept(2 * cosine * wm.z - mu);
      const double squaredCosT = 1 - (1 - square(cosine)) / square(eta);
      if (squaredCosT <= 0) {
        sum += 2 * t * glm::dvec2(reflected);
        continue;
      }
      const double cosT = std::sqrt(squaredCosT);
      const double transmitted = kept(mu / eta - (cosine / eta - cosT) * wm.z);
      const double reflectance = fresnel(cosine, cosT, eta);
      sum += 2 * t * glm::dvec2(std::lerp(transmitted, reflected, reflectance), transmitted);
    }
  }
  return glm::max(1.0 - sum / double(kHeightCount * kAzimuthCount), 0.0);
}

/// One half of a table: from the side whose other side has the index eta, relative.
std::vector<glm::vec2> lossFrom(double eta, glm::dvec2 used) {
  std::vector<glm::vec2> values;
  std::vector<glm::vec2> means;
  for (uint32_t r = 0; r < gpu::kGlassLossRoughnessCount; ++r) {
    constexpr double kSpacing = 1.0 / (gpu::kGlassLossRoughnessCount - 1);
    const double roughness = r * kSpacing;
    const bool skipped = r == 0 || roughness < used.x - kSpacing || roughness > used.y + kSpacing;
    std::array<glm::dvec2, gpu::kGlassLossMuCount> row;
    for (uint32_t c = 0; c < gpu::kGlassLossMuCount; ++c) {
      const double mu = square(c / double(gpu::kGlassLossMuCount - 1));
      row[c] = skipped ? glm::dvec2(0) : directionalLoss(mu, square(roughness), eta);
      values.emplace_back(row[c]);
    }
    means.emplace_back(cosineMean(row));
  }
  values.insert(values.end(), means.begin(), means.end());
  return values;
}

} // namespace

std::vector<glm::vec2> glassLossTable(double ior, glm::dvec2 roughness) {
  const double index = std::clamp(ior, 1.0, 1024.0);
  auto inside = std::async(std::launch::async, lossFrom, 1 / index, roughness);
  std::vector<glm::vec2> table = lossFrom(index, roughness);
  const std::vector<glm::vec2> half = inside.get();
  table.insert(table.end(), half.begin(), half.end());
  return table;
}

} // namespace isophote
