#include "oracle/bsdf_fresnel.hpp"

#include <algorithm>
#include <cmath>

namespace isophote::oracle {

double fresnelDielectric(double cosI, double eta) {
  if (eta == 1) return 0; // no boundary; the formula below is 0 / 0 at cosI = 0
  const double sinT2 = (1 - cosI * cosI) / (eta * eta);
  if (sinT2 >= 1) return 1;
  const double cosT = std::sqrt(1 - sinT2);
  const double s = (cosI - eta * cosT) / (cosI + eta * cosT);
  const double p = (eta * cosI - cosT) / (eta * cosI + cosT);
  return (s * s + p * p) / 2;
}

glm::dvec3 fresnelSchlick(const glm::dvec3& f0, const glm::dvec3& f90, double cosine) {
  return f0 + (f90 - f0) * std::pow(1 - std::clamp(cosine, 0.0, 1.0), 5);
}

} // namespace isophote::oracle
