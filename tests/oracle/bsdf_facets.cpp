#include "oracle/bsdf_facets.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "oracle/bsdf_fresnel.hpp"

namespace isophote::oracle {
namespace {

using std::numbers::pi;

/// Length of the slope, in units of alpha, that the share u of D cos has not passed.
double slopeQuantile(Ndf ndf, double u, double area) {
  switch (ndf) {
  case Ndf::Ggx:
    return std::sqrt((1 - u) / u);
  case Ndf::Beckmann:
    return std::sqrt(-std::log(u));
  default:
    return std::sqrt(std::expm1(-area * std::log(u)) / area); // cos^(n+2) = u, n + 2 = 2 / area
  }
}

/// Mean of |a + b cos(phi)| over azimuths, a >= 0.
double azimuthMean(double a, double b) {
  return b <= a ? a : 2 / pi * (std::sqrt(b * b - a * a) + a * std::asin(a / b));
}

double lambda(Ndf ndf, const glm::dvec3& w, const glm::dvec2& alpha) {
  return (projectedArea(ndf, w, alpha) / w.z - 1) / 2;
}

} // namespace

double facetD(Ndf ndf, const glm::dvec3& wm, const glm::dvec2& alpha) {
  const double cos2 = wm.z * wm.z;
  const double area = alpha.x * alpha.y;
  const double slope2 = (wm.x * wm.x / (alpha.x * alpha.x) + wm.y * wm.y / (alpha.y * alpha.y)) / cos2;
  double slopes = 0; // density of slopes in units of alpha, times pi
  if (ndf == Ndf::Ggx) slopes = std::pow(1 + slope2, -2);
  if (ndf == Ndf::Beckmann) slopes = std::exp(-slope2);
  if (ndf == Ndf::BlinnPhong) {
    const double exponent = 2 / area - 2; // cos^n = (1 + tan^2)^(-n/2); D cos^4 is the density of slopes
    slopes = (exponent + 2) * area / 2 * std::pow(1 + area * slope2, -(exponent + 4) / 2);
  }
  return slopes / (pi * area * cos2 * cos2);
}

double projectedArea(Ndf ndf, const glm::dvec3& w, const glm::dvec2& alpha) {
  const double across = glm::length(alpha * glm::dvec2(w));
  constexpr int kCount = 4000;
  double sum = 0;
  for (int i = 0; i < kCount; ++i) {
    const double t = (i + 0.5) / kCount; // u = t^4: nodes crowd at steep slopes
    sum += 4 * t * t * t / kCount * azimuthMean(w.z, across * slopeQuantile(ndf, std::pow(t, 4), alpha.x * alpha.y));
  }
  return sum;
}

double facetG1(Ndf ndf, const glm::dvec3& w, const glm::dvec2& alpha) { return 1 / (1 + lambda(ndf, w, alpha)); }

double facetG2(FacetKind kind, const glm::dvec3& wo, const glm::dvec3& wi, const glm::dvec2& alpha) {
  const double o = lambda(kind.ndf, wo, alpha), i = lambda(kind.ndf, wi, alpha);
  return kind.masking == Masking::Correlated ? 1 / (1 + o + i) : 1 / ((1 + o) * (1 + i));
}

double pdfFacetSeen(Ndf ndf, const glm::dvec3& wo, const glm::dvec3& wm, const glm::dvec2& alpha) {
  const double cosine = glm::dot(wo, wm);
  if (cosine <= 0) return 0;
  const double g1 = ndf == Ndf::Ggx ? facetG1(ndf, wo, alpha) : std::min(1.0, 2 * wm.z * wo.z / cosine);
  return g1 * cosine * facetD(ndf, wm, alpha) / wo.z;
}

glm::dvec2 facetAlbedo(FacetKind kind, const glm::dvec3& wo, const glm::dvec2& alpha, int count, double exactIor) {
  const double normal = exactIor >= 1 ? fresnelDielectric(1, exactIor) : 0;
  // Lambda depends on the ratio of the width that w sees to its cosine alone, for one product of widths.
  constexpr int kNodes = 2000;
  static thread_local std::array<double, kNodes + 1> nodes;
  static thread_local std::pair<Ndf, double> known{Ndf::Ggx, -1};
  const double area = alpha.x * alpha.y;
  if (kind.ndf != Ndf::Ggx && known != std::pair(kind.ndf, area)) {
    for (int i = 0; i <= kNodes; ++i) {
      const double angle = pi / 2 * i / kNodes; // tan = across / (z sqrt(area))
      const double r = std::sqrt(area);
      nodes[size_t(i)] = projectedArea(kind.ndf, glm::dvec3(std::sin(angle), 0, std::cos(angle)), glm::dvec2(r));
    }
    known = {kind.ndf, area};
  }
  // |w stretched| times the projected area of the unit vector along it.
  const auto length = [&](const glm::dvec3& w) {
    if (kind.ndf == Ndf::Ggx) return std::hypot(glm::length(alpha * glm::dvec2(w)), w.z); // Heitz 2014, eq. 86
    const glm::dvec2 across = alpha * glm::dvec2(w) / std::sqrt(area);
    const double position = std::atan2(glm::length(across), w.z) / (pi / 2) * kNodes;
    const int i = std::min(int(position), kNodes - 1);
    return std::hypot(glm::length(across), w.z) * std::lerp(nodes[size_t(i)], nodes[size_t(i) + 1], position - i);
  };
  const double lengthO = length(wo);
  glm::dvec2 sum(0);
  for (int i = 0; i < count; ++i) {
    const double t = (i + 0.5) / count; // u = t^3: nodes crowd at steep slopes
    const double slope = slopeQuantile(kind.ndf, t * t * t, area);
    for (int j = 0; j < 2 * count; ++j) {
      const double phi = pi * (j + 0.5) / count;
      const glm::dvec3 wm = glm::normalize(glm::dvec3(slope * alpha * glm::dvec2(std::cos(phi), std::sin(phi)), 1));
      const double cosine = glm::dot(wo, wm);
      const glm::dvec3 wi = 2 * cosine * wm - wo;
      if (cosine <= 0 || wi.z <= 0) continue;
      const double lengthI = length(wi);
      const double o = (lengthO / wo.z - 1) / 2, k = (lengthI / wi.z - 1) / 2;
      const double g2 = kind.masking == Masking::Correlated ? 1 / (1 + o + k) : 1 / ((1 + o) * (1 + k));
      const double x = exactIor >= 1 ? (fresnelDielectric(cosine, exactIor) - normal) / (1 - normal)
                                     : std::pow(1 - std::min(cosine, 1.0), 5);
      sum +=
          3 * t * t * g2 * cosine / (wo.z * wm.z) * glm::dvec2(1 - x, x); // D G2 cosine / wo.z over the density D wm.z
    }
  }
  return sum / (2.0 * count * count);
}

} // namespace isophote::oracle
