// Spheres and suns of the reference tracer: lights of KHR_lights_punctual with a radius.
#pragma once

#include <glm/glm.hpp>

#include "isophote/scene.hpp"
#include "oracle/ray.hpp"

namespace isophote::oracle {

/// Distance at which a ray first meets the light's sphere within (tMin, tMax), from inside too; kInfinity where it does
/// not.
[[nodiscard]] double intersectSphere(const PunctualLight& light, const Ray& ray);

/// Radiance from a sphere light at `position` in direction wi, in which it is seen.
[[nodiscard]] glm::dvec3 sphereRadiance(const PunctualLight& light, glm::dvec3 position, glm::dvec3 wi);

/// The directions in which the light's sphere is seen from `position`: all within an angle of `axis` whose cosine is
/// 1 - `oneMinusCos`; from inside all, oneMinusCos = 2.
struct Cone {
  glm::dvec3 axis{0, 0, 1};
  double oneMinusCos = 2;

  [[nodiscard]] glm::dvec3 sample(glm::dvec2 u) const; ///< uniform in solid angle
  [[nodiscard]] double pdf() const { return 1 / (2 * kPi * oneMinusCos); }
  [[nodiscard]] bool contains(glm::dvec3 direction) const;
};
[[nodiscard]] Cone sphereCone(const PunctualLight& light, glm::dvec3 position);
[[nodiscard]] Cone sunCone(const PunctualLight& sun);

/// The sun's irradiance on a surface facing its center is the light's intensity: radiance of a uniform disk.
[[nodiscard]] glm::dvec3 sunRadiance(const PunctualLight& sun);

} // namespace isophote::oracle
