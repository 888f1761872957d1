#include "oracle/scattering.hpp"

#include <cmath>

namespace isophote::oracle {

Scattering::Scattering(const SurfacePoint& point, glm::dvec3 wo) : point_(point), wo_(wo) {
  const glm::dvec3 axis = std::abs(point.ns.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  tangent_ = glm::normalize(glm::cross(axis, point.ns));
  bitangent_ = glm::cross(point.ns, tangent_);
}

bool Scattering::above(glm::dvec3 w) const { return glm::dot(point_.ng, w) > 0 && glm::dot(point_.ns, w) > 0; }

ScatterValue Scattering::evaluate(glm::dvec3 wi) const {
  if (!above(wo_) || !above(wi)) return {};
  const double cosine = glm::dot(point_.ns, wi);
  return {point_.material.baseColor * (cosine / kPi), cosine / kPi};
}

ScatterSample Scattering::sample(RandomStream& random) const {
  if (!above(wo_)) return {};
  const glm::dvec2 u = random.next2();
  const double r = std::sqrt(u.x), phi = 2 * kPi * u.y;
  const double z = std::sqrt(1 - u.x);
  ScatterSample result;
  result.wi = r * std::cos(phi) * tangent_ + r * std::sin(phi) * bitangent_ + z * point_.ns;
  const ScatterValue value = evaluate(result.wi);
  result.pdf = value.pdf;
  if (value.pdf > 0) result.weight = value.value / value.pdf;
  return result;
}

} // namespace isophote::oracle
