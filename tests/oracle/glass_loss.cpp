#include "oracle/glass_loss.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <mutex>
#include <tuple>

#include "oracle/bsdf_fresnel.hpp"
#include "oracle/bsdf_ggx.hpp"

namespace isophote::oracle {
namespace {

constexpr int kMuNodes = 49;        // at mu = (i / 48)^2
constexpr int kRoughnessNodes = 33; // at sqrt(alpha) = i / 32
constexpr int kTableQuadrature = 48;

double lambda(double z, double alpha) { return (std::sqrt(1 + alpha * alpha * (1 / (z * z) - 1)) - 1) / 2; }

struct Row {
  std::array<glm::dvec2, kMuNodes> values;
  glm::dvec2 mean{0};
};

glm::dvec2 linear(const Row& row, double mu) {
  const double position = std::sqrt(std::clamp(mu, 0.0, 1.0)) * (kMuNodes - 1);
  const auto i = static_cast<size_t>(std::min(static_cast<int>(position), kMuNodes - 2));
  return glm::mix(row.values[i], row.values[i + 1], position - static_cast<double>(i));
}

const Row& rowOf(double eta, int r) {
  static std::mutex mutex;
  static std::map<std::tuple<double, int>, Row> rows;
  const std::scoped_lock lock(mutex);
  const auto [entry, isNew] = rows.try_emplace({eta, r});
  Row& row = entry->second;
  if (!isNew) return row;
  const double alpha = std::pow(r / double(kRoughnessNodes - 1), 2);
  for (int i = 0; i < kMuNodes; ++i)
    row.values[static_cast<size_t>(i)] =
        quadratureGlassLoss(std::pow(i / double(kMuNodes - 1), 2), alpha, eta, kTableQuadrature);
  const int steps = 2048; // midpoints of 2 mu dmu = d(mu^2)
  for (int i = 0; i < steps; ++i) row.mean += linear(row, std::sqrt((i + 0.5) / steps)) / double(steps);
  return row;
}

template <class At> double interpolate(double alpha, double specular, const At& at) {
  const double position = std::sqrt(std::clamp(alpha, 0.0, 1.0)) * (kRoughnessNodes - 1);
  const int r = std::min(static_cast<int>(position), kRoughnessNodes - 2);
  const glm::dvec2 loss = glm::mix(at(r), at(r + 1), position - r);
  return std::lerp(loss.y, loss.x, specular);
}

} // namespace

glm::dvec2 quadratureGlassLoss(double mu, double alpha, double eta, int count) {
  if (alpha == 0) return glm::dvec2(0);
  mu = std::max(mu, 1e-6);
  const glm::dvec3 wo(std::sqrt(1 - mu * mu), 0, mu);
  const double lambdaO = lambda(mu, alpha);
  const auto kept = [&](double z) { return z > 0 ? (1 + lambdaO) / (1 + lambdaO + lambda(z, alpha)) : 0; };
  glm::dvec2 sum(0);
  for (int i = 0; i < count; ++i) {
    const double t = (i + 0.5) / count;
    for (int j = 0; j < count; ++j) {
      const glm::dvec2 u(1 - t * t, 0.25 + 0.5 * (j + 0.5) / count); // mirror symmetry: half of all azimuths suffice
      const glm::dvec3 wm = sampleVisibleNormal(wo, glm::dvec2(alpha), u);
      const double cosine = glm::dot(wo, wm);
      const double reflectance = fresnelDielectric(cosine, eta);
      const double reflected = kept(2 * cosine * wm.z - mu);
      double transmitted = 0;
      const double squaredCosT = 1 - (1 - cosine * cosine) / (eta * eta);
      const bool total = squaredCosT <= 0;
      if (!total) transmitted = kept((mu - (cosine - eta * std::sqrt(squaredCosT)) * wm.z) / eta);
      const double none = total ? reflected : transmitted;
      sum += 2 * t * glm::dvec2(total ? reflected : std::lerp(transmitted, reflected, reflectance), none);
    }
  }
  return 1.0 - sum / (double(count) * count);
}

double glassLoss(double mu, double alpha, double eta, double specular) {
  return interpolate(alpha, specular, [&](int r) { return linear(rowOf(eta, r), mu); });
}

double glassMeanLoss(double alpha, double eta, double specular) {
  return interpolate(alpha, specular, [&](int r) { return rowOf(eta, r).mean; });
}

} // namespace isophote::oracle
