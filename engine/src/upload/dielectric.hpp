// Reflectance between dielectrics in double precision, for the tables.
#pragma once

#include <cmath>

namespace isophote {

/// Reflectance of unpolarized light, 1 beyond the critical angle. Source: Born and Wolf 1999, section 1.5.2, eq. 21.
/// @param eta index behind the boundary over the index in front
inline double dielectricReflectance(double cosI, double eta) {
  const double squaredCosT = 1 - (1 - cosI * cosI) / (eta * eta);
  if (squaredCosT <= 0) return 1;
  const double cosT = std::sqrt(squaredCosT);
  const double s = (cosI - eta * cosT) / (cosI + eta * cosT);
  const double p = (eta * cosI - cosT) / (eta * cosI + cosT);
  return 0.5 * (s * s + p * p);
}

/// Schlick's approximation of it, by the cosine on the less dense side.
inline double schlickReflectance(double cosI, double eta) {
  const double squaredCosT = 1 - (1 - cosI * cosI) / (eta * eta);
  if (squaredCosT <= 0) return 1;
  const double normal = (eta - 1) * (eta - 1) / ((eta + 1) * (eta + 1));
  return normal + (1 - normal) * std::pow(1 - (eta < 1 ? std::sqrt(squaredCosT) : cosI), 5);
}

} // namespace isophote
