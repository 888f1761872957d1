#include "oracle/bsdf_ggx.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <numbers>

namespace isophote::oracle {
namespace {

using std::numbers::pi;

double lambda(const glm::dvec3& w, const glm::dvec2& alpha) {
  const double tangential2 = alpha.x * alpha.x * w.x * w.x + alpha.y * alpha.y * w.y * w.y;
  return (std::sqrt(1 + tangential2 / (w.z * w.z)) - 1) / 2;
}

// G2 / G1(wo) multiplied through by the cosines, so that wo may lie on the horizon.
double visibleWeight(const glm::dvec3& wo, const glm::dvec3& wi, double alpha) {
  const auto root = [alpha](const glm::dvec3& w) {
    return std::sqrt(alpha * alpha * (w.x * w.x + w.y * w.y) + w.z * w.z);
  };
  return wi.z * (wo.z + root(wo)) / (wo.z * root(wi) + wi.z * root(wo));
}

constexpr int kMuNodes = 65;        // at mu = (i / 64)^2: the integrals bend fastest at grazing angles
constexpr int kRoughnessNodes = 65; // at sqrt(alpha) = i / 64
constexpr int kTableQuadrature = 80;

struct AlbedoRow {
  std::once_flag filled;
  std::array<glm::dvec2, kMuNodes> values;
  glm::dvec2 mean;
};

double cubic(double p0, double p1, double p2, double p3, double t) {
  return p1 + t / 2 * (p2 - p0 + t * (2 * p0 - 5 * p1 + 4 * p2 - p3 + t * (3 * (p1 - p2) + p3 - p0)));
}

glm::dvec2 cubic(const glm::dvec2& p0, const glm::dvec2& p1, const glm::dvec2& p2, const glm::dvec2& p3, double t) {
  return {cubic(p0.x, p1.x, p2.x, p3.x, t), cubic(p0.y, p1.y, p2.y, p3.y, t)};
}

// Catmull-Rom through at(0..nodes-1); ends are continued linearly.
template <class At> glm::dvec2 interpolate(const At& at, int nodes, double position) {
  const int i = std::clamp(static_cast<int>(position), 0, nodes - 2);
  const glm::dvec2 p1 = at(i);
  const glm::dvec2 p2 = at(i + 1);
  const double t = position - i;
  const glm::dvec2 p0 = i > 0 ? at(i - 1) : 2.0 * p1 - p2;
  const glm::dvec2 p3 = i + 2 < nodes ? at(i + 2) : 2.0 * p2 - p1;
  return cubic(p0, p1, p2, p3, t);
}

glm::dvec2 evaluateRow(const AlbedoRow& row, double mu) {
  const auto at = [&row](int i) { return row.values[static_cast<size_t>(i)]; };
  return interpolate(at, kMuNodes, std::sqrt(std::clamp(mu, 0.0, 1.0)) * (kMuNodes - 1));
}

const AlbedoRow& albedoRow(int r) {
  static std::array<AlbedoRow, kRoughnessNodes> rows;
  AlbedoRow& row = rows[static_cast<size_t>(r)];
  std::call_once(row.filled, [&row, r] {
    const double roughness = r / double(kRoughnessNodes - 1);
    for (int i = 0; i < kMuNodes; ++i) {
      const double root = i / double(kMuNodes - 1);
      row.values[static_cast<size_t>(i)] = quadratureAlbedo(root * root, roughness * roughness, kTableQuadrature);
    }
    const int steps = 4096; // midpoints of 2 mu dmu = d(mu^2)
    for (int i = 0; i < steps; ++i) row.mean += evaluateRow(row, std::sqrt((i + 0.5) / steps)) / double(steps);
  });
  return row;
}

} // namespace

double ggxD(const glm::dvec3& wm, const glm::dvec2& alpha) {
  const double cos2 = wm.z * wm.z;
  const double slope2 = wm.x * wm.x / (alpha.x * alpha.x) + wm.y * wm.y / (alpha.y * alpha.y);
  const double factor = 1 + slope2 / cos2;
  return 1 / (pi * alpha.x * alpha.y * cos2 * cos2 * factor * factor);
}

double ggxG1(const glm::dvec3& w, const glm::dvec2& alpha) { return 1 / (1 + lambda(w, alpha)); }

double ggxG2(const glm::dvec3& wo, const glm::dvec3& wi, const glm::dvec2& alpha) {
  return 1 / (1 + lambda(wo, alpha) + lambda(wi, alpha));
}

double pdfVisibleNormal(const glm::dvec3& wo, const glm::dvec3& wm, const glm::dvec2& alpha) {
  return ggxG1(wo, alpha) * std::max(0.0, glm::dot(wo, wm)) * ggxD(wm, alpha) / wo.z;
}

glm::dvec3 sampleVisibleNormal(const glm::dvec3& wo, const glm::dvec2& alpha, const glm::dvec2& u) {
  const glm::dvec3 stretched = glm::normalize(glm::dvec3(alpha.x * wo.x, alpha.y * wo.y, wo.z));
  const double length2 = stretched.x * stretched.x + stretched.y * stretched.y;
  const glm::dvec3 axis1 =
      length2 > 0 ? glm::dvec3(-stretched.y, stretched.x, 0) / std::sqrt(length2) : glm::dvec3(1, 0, 0);
  const glm::dvec3 axis2 = glm::cross(stretched, axis1);
  const double radius = std::sqrt(u.x);
  const double phi = 2 * pi * u.y;
  const double t1 = radius * std::cos(phi);
  const double s = (1 + stretched.z) / 2;
  const double t2 = (1 - s) * std::sqrt(1 - t1 * t1) + s * radius * std::sin(phi);
  const double t3 = std::sqrt(std::max(0.0, 1 - t1 * t1 - t2 * t2));
  const glm::dvec3 normal = t1 * axis1 + t2 * axis2 + t3 * stretched;
  return glm::normalize(glm::dvec3(alpha.x * normal.x, alpha.y * normal.y, std::max(0.0, normal.z)));
}

glm::dvec2 quadratureAlbedo(double mu, double alpha, int count) {
  const auto schlick = [](double cosine) {
    const double x = 1 - std::clamp(cosine, 0.0, 1.0);
    return x * x * x * x * x;
  };
  if (alpha == 0) return {1 - schlick(mu), schlick(mu)};
  const glm::dvec3 wo(std::sqrt(std::max(0.0, 1 - mu * mu)), 0, mu);
  glm::dvec2 sum(0);
  for (int i = 0; i < count; ++i) {
    const double t =
        (i + 0.5) / count; // u.x = 1 - t^2 puts nodes where normals lie flat and wi sinks below the horizon
    for (int j = 0; j < count; ++j) {
      const glm::dvec2 u(1 - t * t, 0.25 + 0.5 * (j + 0.5) / count); // mirror symmetry: half of all azimuths suffice
      const glm::dvec3 wm = sampleVisibleNormal(wo, glm::dvec2(alpha), u);
      const double cosine = glm::dot(wo, wm);
      const glm::dvec3 wi = 2 * cosine * wm - wo;
      if (wi.z <= 0) continue;
      const double weight = 2 * t * visibleWeight(wo, wi, alpha);
      sum += weight * glm::dvec2(1 - schlick(cosine), schlick(cosine));
    }
  }
  return sum / (double(count) * count);
}

glm::dvec2 directionalAlbedo(double mu, double alpha) {
  const double position = std::sqrt(std::clamp(alpha, 0.0, 1.0)) * (kRoughnessNodes - 1);
  const int nearest = static_cast<int>(std::lround(position));
  if (std::abs(position - nearest) < 1e-12) return evaluateRow(albedoRow(nearest), mu);
  return interpolate([mu](int r) { return evaluateRow(albedoRow(r), mu); }, kRoughnessNodes, position);
}

glm::dvec2 meanAlbedo(double alpha) {
  const double position = std::sqrt(std::clamp(alpha, 0.0, 1.0)) * (kRoughnessNodes - 1);
  const int nearest = static_cast<int>(std::lround(position));
  if (std::abs(position - nearest) < 1e-12) return albedoRow(nearest).mean;
  return interpolate([](int r) { return albedoRow(r).mean; }, kRoughnessNodes, position);
}

} // namespace isophote::oracle
