// Solid angles of triangles by the angles between planes.
//
// Why sampling needs no such angle: with unit directions d0, d1 and x = 2 (d0.h) h - d0, the mirror image of d0 at a
// unit h, the solid angle S of (d0, d1, x) has tan(S / 2) = det(d0, d1, x) / (1 + d0.d1 + d0.x + d1.x) (van Oosterom
// and Strackee 1983), and both the numerator and the denominator have the factor 2 d0.h; what is left, det(d0, d1, h)
// and d0.h + d1.h, is linear in h. For h on the plane of d0 and d2, h = a d0 + b d2 up to a factor, a wanted S gives a
// : b.
#pragma once

#include <array>
#include <cmath>

#include <glm/glm.hpp>

namespace isophote::oracle {

/// Steradian, by Girard's theorem (spherical excess); absolute error about 1e-15.
[[nodiscard]] inline double solidAngle(const std::array<glm::dvec3, 3>& vertices, glm::dvec3 p) {
  std::array<glm::dvec3, 3> planes; // normals of the planes through p and two vertices
  for (size_t i = 0; i < 3; ++i) planes[i] = glm::cross(vertices[i] - p, vertices[(i + 1) % 3] - p);
  double excess = -3.14159265358979323846;
  for (size_t i = 0; i < 3; ++i) {
    const glm::dvec3 a = planes[i];
    const glm::dvec3 b = -planes[(i + 2) % 3];
    excess += std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
  }
  return excess;
}

} // namespace isophote::oracle
