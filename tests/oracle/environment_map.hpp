// The environment in double: bilinear radiance and importance sampling by texel.
#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "isophote/scene.hpp"

namespace isophote::oracle {

/// Borrows the Environment.
class EnvironmentMap {
public:
  explicit EnvironmentMap(const Environment& environment);

  /// Radiance arriving from direction `d` (unit, away from the receiver): row 0 is +y, u = 0.5 + atan2(d.x, -d.z) /
  /// 2pi, v = acos(d.y) / pi, rotated by `rotation` about +y from map to world. Bilinear between texel centers,
  /// periodic in u, clamped in v.
  [[nodiscard]] glm::dvec3 radiance(glm::dvec3 d) const;

  /// Draws a direction; its density per steradian is pdf().
  [[nodiscard]] glm::dvec3 sample(double uTexel, glm::dvec2 uInside) const;
  [[nodiscard]] double pdf(glm::dvec3 d) const;

  /// Integral over the sphere of the largest channel of the 3x3 neighbourhoods' maxima: an upper bound on the integral
  /// of radiance, 0 exactly where the map is black.
  [[nodiscard]] double power() const { return total_; }

private:
  [[nodiscard]] glm::dvec3 mapFromWorld(glm::dvec3 d) const;
  [[nodiscard]] glm::dvec3 texel(int64_t x, int64_t y) const;
  [[nodiscard]] double texelSolidAngle(uint32_t y) const;

  const Environment* environment_;
  std::vector<double> cumulative_; ///< over texels in row order, starts with 0
  double total_ = 0;
};

} // namespace isophote::oracle
