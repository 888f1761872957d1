// Homogeneous media in double precision, from the textbook formulas.
#pragma once

#include <glm/glm.hpp>

#include "isophote/scene.hpp"

namespace isophote::oracle {

/// Henyey and Greenstein 1941, per steradian. @param cosine  between the directions of flight before and after
[[nodiscard]] double henyeyGreenstein(double cosine, double g);

/// Inverse of the distribution of the cosine. @param u  uniform in [0, 1)
[[nodiscard]] double sampleHenyeyGreensteinCosine(double g, double u);

struct MediumCoefficients {
  glm::dvec3 extinction{0}; ///< per unit of length
  glm::dvec3 albedo{0};     ///< of one scattering
  double anisotropy = 0;
};

/// KHR_materials_volume: sigma_t = -ln(c) / d; KHR_materials_volume_scatter: single from multiple-scattering albedo
/// (Kulla and Conty 2017). A channel of attenuation color 0 gets the device's finite stand-in, 1e9 / d.
[[nodiscard]] MediumCoefficients mediumCoefficients(const Volume& volume);

} // namespace isophote::oracle
