// Rays and hits of the reference tracer.
#pragma once

#include <cstdint>
#include <limits>

#include <glm/glm.hpp>

namespace isophote::oracle {

inline constexpr uint32_t kNoTriangle = 0xffffffffu;
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kPi = 3.14159265358979323846;

struct Ray {
  glm::dvec3 origin{0};
  glm::dvec3 direction{0, 0, -1}; ///< unit
  double tMin = 0;                ///< world units along `direction`
  double tMax = kInfinity;
  uint32_t leaving = kNoTriangle;  ///< triangle the origin lies on: it is flat, so it cannot be hit again
  uint32_t arriving = kNoTriangle; ///< triangle a shadow ray ends on: not an occluder
};

struct Hit {
  uint32_t triangle = kNoTriangle; ///< kNoTriangle: the ray escaped
  double t = kInfinity;
  double b1 = 0, b2 = 0; ///< barycentric weights of vertices 1 and 2
};

} // namespace isophote::oracle
