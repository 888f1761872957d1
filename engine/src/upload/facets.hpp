// Microfacets in double precision, for the tables: the twin of shaders/bsdf/facet_distribution.glsl.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <glm/glm.hpp>

#include "isophote/settings.hpp"

namespace isophote {

/// Which facets a render has.
struct FacetModel {
  Ndf ndf = Ndf::Ggx;
  Masking masking = Masking::Correlated;
  auto operator<=>(const FacetModel&) const = default;
};

/// The facets of one width. Directions are unit, in the local shading frame, z up.
class Facets {
public:
  /// @param alpha width along x and y, in [1e-3, 1]
  Facets(FacetModel model, glm::dvec2 alpha) : model_(model), alpha_(alpha) {}

  [[nodiscard]] glm::dvec2 alpha() const { return alpha_; }

  /// S = z (1 + 2 Lambda(w)) of Smith's masking; formulas and sources as on the device.
  [[nodiscard]] double projectedLength(const glm::dvec3& w) const;

  [[nodiscard]] double ggxProjectedLength(const glm::dvec3& w) const {
    return glm::length(glm::dvec3(alpha_ * glm::dvec2(w), w.z));
  }

  /// The distribution's density over that of GGX, at the normal of the given slope in units of alpha.
  [[nodiscard]] double ratioToGgx(double squaredSlope) const;

  /// G2 / (2 cos wo): of light that leaves along wi, to the side it should, at |wi.z| > 0.
  /// @param lengthO projectedLength(wo)
  [[nodiscard]] double passage(const glm::dvec3& wo, double lengthO, const glm::dvec3& wi) const {
    const double z = std::abs(wi.z);
    const double lengthI = projectedLength(glm::dvec3(wi.x, wi.y, z));
    return model_.masking == Masking::Correlated ? z / (wo.z * lengthI + z * lengthO)
                                                 : 2 * z / ((wo.z + lengthO) * (z + lengthI));
  }

private:
  FacetModel model_;
  glm::dvec2 alpha_;
};

struct NormalQuadrature {
  int heights;
  int azimuths;
  bool halfTurn; ///< wo.y = 0 and the facets are isotropic: the integrand is symmetric in y
};

/// Calls visit(wm, cosine, weight) with normals that wo may see; cosine = dot(wo, wm).
///
/// Sums of weight * passage(...) * f over them approximate the integral over all directions of a lobe of reflectance f:
/// the normals are GGX's visible ones by spherical caps (Dupuy and Benyoub 2023, "Sampling Visible GGX Normals with
/// Spherical Caps"), weighed to be the model's.
template <class Visit>
void forVisibleNormals(const Facets& facets, const glm::dvec3& wo, const NormalQuadrature& size, Visit&& visit) {
  const glm::dvec2 alpha = facets.alpha();
  const glm::dvec3 view = glm::normalize(glm::dvec3(alpha * glm::dvec2(wo), wo.z));
  const double turn = size.halfTurn ? std::numbers::pi : 2 * std::numbers::pi;
  std::vector<glm::dvec2> directions;
  for (int j = 0; j < size.azimuths; ++j) {
    const double phi = turn * (j + 0.5) / size.azimuths;
    directions.emplace_back(std::cos(phi), std::sin(phi));
  }
  const double scale = 2 * (wo.z + facets.ggxProjectedLength(wo)) / (double(size.heights) * size.azimuths);
  for (int i = 0; i < size.heights; ++i) {
    // Quadratic in t: nodes crowd at flat normals, where wi sinks below the horizon.
    const double t = (i + 0.5) / size.heights;
    const double height = t * t * (1 + view.z); // above the cap's rim at z = -view.z
    const double z = height - view.z;
    const double radius = std::sqrt(std::max(0.0, 1 - z * z));
    for (const glm::dvec2& direction : directions) {
      const glm::dvec2 unit = radius * direction + glm::dvec2(view);
      const glm::dvec3 wm = glm::normalize(glm::dvec3(alpha * unit, height));
      const double weight = scale * t * facets.ratioToGgx(glm::dot(unit, unit) / (height * height));
      visit(wm, std::min(glm::dot(wo, wm), 1.0), weight);
    }
  }
}

} // namespace isophote
