// Directions and random numbers that the probes of facets and BSDFs take.
#pragma once

#include <cmath>
#include <random>

#include <glm/glm.hpp>

namespace isophote::test {

inline glm::vec3 directionOf(double cosine, double phi) {
  const double sine = std::sqrt(1 - cosine * cosine);
  return {float(sine * std::cos(phi)), float(sine * std::sin(phi)), float(cosine)};
}

/// A multiple of 2^-24 in [0, 1), as kernels draw them.
inline float uniform(std::mt19937& generator) { return float(generator() >> 8) * std::ldexp(1.0f, -24); }

/// A normal whose slope is `slope` in units of alpha.
inline glm::vec3 tiltedNormal(const glm::vec2& alpha, double slope, double phi) {
  const glm::dvec3 normal(double(alpha.x) * slope * std::cos(phi), double(alpha.y) * slope * std::sin(phi), 1);
  return glm::vec3(glm::normalize(normal));
}

} // namespace isophote::test
