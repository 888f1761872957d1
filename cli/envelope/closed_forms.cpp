#include "envelope/closed_forms.hpp"

#include <cmath>

namespace isophote::envelope {

double polygonIrradiance(const std::vector<glm::dvec3>& vertices) {
  double sum = 0;
  for (size_t i = 0; i < vertices.size(); ++i) {
    const glm::dvec3 a = glm::normalize(vertices[i]), b = glm::normalize(vertices[(i + 1) % vertices.size()]);
    const glm::dvec3 across = glm::cross(a, b);
    const double sine = glm::length(across);
    if (sine > 0) sum += std::atan2(sine, glm::dot(a, b)) * across.y / sine;
  }
  return std::abs(sum) / 2;
}

double fresnelReflectance(double cosine, double eta) {
  const double behindSquared = eta * eta - (1 - cosine * cosine); // (eta cos_t)^2
  if (behindSquared <= 0) return 1;
  const double behind = std::sqrt(behindSquared);
  const double s = (cosine - behind) / (cosine + behind);
  const double p = (eta * eta * cosine - behind) / (eta * eta * cosine + behind);
  return (s * s + p * p) / 2;
}

double plateTransmittance(double cosine, double eta) {
  const double reflected = fresnelReflectance(cosine, eta);
  return (1 - reflected) / (1 + reflected);
}

double ggxReflectionOfDisk(double alpha, double radius) {
  // The share p of facets tilted by less than h is tan^2 h / (alpha^2 + tan^2 h) (Walter et al. 2007, eq. 35); light
  // from the angle 2 h is seen by G2 = 1 / (1 + Lambda(2 h)) of them (Heitz 2014, eq. 99), as nothing masks the view.
  const double edge = std::tan(radius / 2);
  const double whole = edge * edge / (alpha * alpha + edge * edge);
  constexpr int kSteps = 4096;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double p = whole * (i + 0.5) / kSteps;
    const double slope = std::tan(2 * std::atan(alpha * std::sqrt(p / (1 - p))));
    sum += 1 / (0.5 + 0.5 * std::sqrt(1 + alpha * alpha * slope * slope));
  }
  return whole * sum / kSteps;
}

} // namespace isophote::envelope
