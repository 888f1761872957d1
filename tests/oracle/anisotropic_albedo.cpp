// Tables of what brushed facets reflect once, for the reference tracer.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <mutex>
#include <numbers>
#include <utility>

#include "oracle/bsdf_facets.hpp"
#include "oracle/bsdf_ggx.hpp"

namespace isophote::oracle {
namespace {

constexpr size_t kMus = 33;      // sqrt(mu)
constexpr size_t kAzimuths = 17; // of a quarter turn; the rest by symmetry
constexpr int kNormals = 64;

struct Table {
  std::array<std::array<glm::dvec2, kMus>, kAzimuths> values;
  glm::dvec2 mean{0};
};

Table makeTable(const glm::dvec2& alpha) {
  Table table;
  for (size_t a = 0; a < kAzimuths; ++a) {
    const double phi = std::numbers::pi / 2 * double(a) / (kAzimuths - 1);
    for (size_t c = 0; c < kMus; ++c) {
      const double root = std::max(double(c) / (kMus - 1), 1e-2);
      const double mu = root * root;
      const double sine = std::sqrt(1 - mu * mu);
      table.values[a][c] = facetAlbedo({}, {sine * std::cos(phi), sine * std::sin(phi), mu}, alpha, kNormals);
    }
  }
  // The mean of what is read: 2 mu dmu = 4 root^3 droot, by the trapezoid rule on a finer grid.
  constexpr int kSteps = 8 * (kMus - 1);
  double weights = 0;
  for (int i = 0; i <= kSteps; ++i) {
    const double root = double(i) / kSteps;
    const double position = root * (kMus - 1);
    const size_t c = std::min(size_t(position), kMus - 2);
    for (size_t a = 0; a < kAzimuths; ++a) {
      const double ends = (i == 0 || i == kSteps ? 0.5 : 1) * (a == 0 || a == kAzimuths - 1 ? 0.5 : 1);
      const double weight = ends * root * root * root;
      table.mean += weight * glm::mix(table.values[a][c], table.values[a][c + 1], position - double(c));
      weights += weight;
    }
  }
  table.mean /= weights;
  return table;
}

const Table& tableOf(const glm::dvec2& alpha) {
  static std::mutex mutex;
  static std::map<std::pair<double, double>, Table> tables;
  const std::lock_guard lock(mutex);
  const auto [entry, isNew] = tables.try_emplace({alpha.x, alpha.y});
  if (isNew) entry->second = makeTable(alpha);
  return entry->second;
}

} // namespace

glm::dvec2 anisotropicAlbedo(const glm::dvec3& w, const glm::dvec2& alpha) {
  const Table& table = tableOf(alpha);
  const double azimuth = std::atan2(std::abs(w.y), std::abs(w.x)) / (std::numbers::pi / 2) * (kAzimuths - 1);
  const double position = std::sqrt(std::abs(w.z)) * (kMus - 1);
  const size_t a = std::min(size_t(azimuth), kAzimuths - 2);
  const size_t c = std::min(size_t(position), kMus - 2);
  const auto row = [&](size_t r) { return glm::mix(table.values[r][c], table.values[r][c + 1], position - double(c)); };
  return glm::mix(row(a), row(a + 1), azimuth - double(a));
}

glm::dvec2 anisotropicMeanAlbedo(const glm::dvec2& alpha) { return tableOf(alpha).mean; }

} // namespace isophote::oracle
