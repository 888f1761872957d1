#include "oracle/medium.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace isophote::oracle {

double henyeyGreenstein(double cosine, double g) {
  return (1 - g * g) / (4 * std::numbers::pi * std::pow(1 + g * g - 2 * g * cosine, 1.5));
}

double sampleHenyeyGreensteinCosine(double g, double u) {
  if (std::abs(g) < 1e-3) {
    // Newton's iteration on the distribution of p = 1/2 (1 + 3 g c) + O(g^2), integrated exactly by its three moments.
    double c = 2 * u - 1;
    for (int i = 0; i < 8; ++i) {
      const double cdf = 0.5 * (c + 1) + 0.75 * g * (c * c - 1) + 1.25 * g * g * (c * c * c - c);
      c -= (cdf - u) / (0.5 + 1.5 * g * c + 1.25 * g * g * (3 * c * c - 1));
    }
    return c;
  }
  const double q = (1 - g * g) / (1 - g + 2 * g * u);
  return (1 + g * g - q * q) / (2 * g);
}

MediumCoefficients mediumCoefficients(const Volume& volume) {
  MediumCoefficients result;
  result.anisotropy = volume.scatterAnisotropy;
  for (int c = 0; c < 3; ++c) {
    const double color = volume.attenuationColor[c];
    if (volume.attenuationDistance > 0)
      result.extinction[c] = std::min(-std::log(color), 1e9) / volume.attenuationDistance;
    const double rho = volume.multiscatterColor[c];
    const double s = 4.09712 + 4.20863 * rho - std::sqrt(9.59217 + 41.6808 * rho + 17.7126 * rho * rho);
    result.albedo[c] = std::clamp(1 - s * s, 0.0, 1.0);
  }
  return result;
}

} // namespace isophote::oracle
