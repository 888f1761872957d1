// The coefficients of homogeneous media, from the colors that authors give.
#pragma once

#include <glm/glm.hpp>

#include "isophote/scene.hpp"

namespace isophote {

struct MediumCoefficients {
  glm::vec3 extinction{0}; ///< absorption and scattering per unit of length; finite
  glm::vec3 albedo{0};     ///< scattering over extinction, in [0, 1]
};

/// Source: KHR_materials_volume, extinction -ln(color) / distance; KHR_materials_volume_scatter (draft), which takes
/// the albedo of one scattering from that of many by Kulla and Conty 2017, "Revisiting Physically Based Shading at
/// Imageworks".
[[nodiscard]] MediumCoefficients mediumCoefficients(const Volume& volume);

/// Whether a surface bounds a medium: it is not thin-walled and lets something pass.
[[nodiscard]] bool isVolume(const Material& material);

/// Whether nothing but refraction happens at a surface: with the same index on both sides it cannot be seen.
[[nodiscard]] bool isClear(const Material& material);

} // namespace isophote
