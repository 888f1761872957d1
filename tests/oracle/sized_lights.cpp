#include "oracle/sized_lights.hpp"

#include <algorithm>
#include <cmath>

namespace isophote::oracle {

double intersectSphere(const PunctualLight& light, const Ray& ray) {
  // |o + t d - c|^2 = r^2, a quadratic equation in t with leading coefficient 1.
  const glm::dvec3 offset = ray.origin - light.position;
  const double half = glm::dot(offset, ray.direction);
  const double constant = glm::dot(offset, offset) - double{light.radius} * light.radius;
  const double discriminant = half * half - constant;
  if (discriminant < 0) return kInfinity;
  for (const double t : {-half - std::sqrt(discriminant), -half + std::sqrt(discriminant)}) {
    if (t > ray.tMin) return t < ray.tMax ? t : kInfinity;
  }
  return kInfinity;
}

glm::dvec3 sphereRadiance(const PunctualLight& light, glm::dvec3 position, glm::dvec3 wi) {
  const double radius = light.radius;
  glm::dvec3 radiance = glm::dvec3(light.intensity) / (kPi * radius * radius);
  if (light.range > 0) {
    const double share = glm::length(light.position - position) / light.range;
    radiance *= std::clamp(1 - std::pow(share, 4), 0.0, 1.0);
  }
  if (light.kind == LightKind::Spot) {
    const double inner = std::cos(double{light.innerConeAngle}), outer = std::cos(double{light.outerConeAngle});
    const double falloff =
        std::clamp((glm::dot(-wi, light.direction) - outer) / std::max(0.001, inner - outer), 0.0, 1.0);
    radiance *= falloff * falloff;
  }
  return radiance;
}

glm::dvec3 Cone::sample(glm::dvec2 u) const {
  const double cosTheta = 1 - u.x * oneMinusCos;
  const double sinTheta = std::sqrt(u.x * oneMinusCos * (1 + cosTheta));
  const double phi = 2 * kPi * u.y;
  const glm::dvec3 helper = std::abs(axis.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 s = glm::normalize(glm::cross(helper, axis)), t = glm::cross(axis, s);
  return glm::normalize(sinTheta * std::cos(phi) * s + sinTheta * std::sin(phi) * t + cosTheta * axis);
}

bool Cone::contains(glm::dvec3 direction) const {
  const glm::dvec3 chord = direction - axis;
  return glm::dot(chord, chord) <= 2 * oneMinusCos;
}

Cone sphereCone(const PunctualLight& light, glm::dvec3 position) {
  const glm::dvec3 toCenter = light.position - position;
  const double distance = glm::length(toCenter);
  if (distance <= light.radius) return {};
  const double sine = light.radius / distance;
  return {toCenter / distance, sine * sine / (1 + std::sqrt(1 - sine * sine))};
}

Cone sunCone(const PunctualLight& sun) {
  const double half = std::sin(0.5 * sun.radius);
  return {-glm::normalize(sun.direction), 2 * half * half};
}

glm::dvec3 sunRadiance(const PunctualLight& sun) {
  const double sine = std::sin(double{sun.radius});
  return glm::dvec3(sun.intensity) / (kPi * sine * sine);
}

} // namespace isophote::oracle
