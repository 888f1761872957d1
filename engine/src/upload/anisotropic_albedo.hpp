// The tables behind shaders/bsdf/anisotropic_albedo.glsl.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "upload/facets.hpp"

namespace isophote {

/// The roughness and strength that a material with KHR_materials_anisotropy can have, from .x to .y each.
struct AnisotropicSurface {
  glm::vec2 roughness{0, 1};
  glm::vec2 strength{0, 1};
  bool operator==(const AnisotropicSurface&) const = default;
};

/// Widths of the facets along x and y, as on the device. Source: Khronos, KHR_materials_anisotropy.
[[nodiscard]] glm::dvec2 anisotropicWidth(double roughness, double strength);

/// Items of the surface's table.
[[nodiscard]] uint32_t anisotropicAlbedoSize(const AnisotropicSurface& surface);

/// The integrals (A, B) of facetAlbedoTable for anisotropic facets, laid out as shared/bsdf_constants.h says. One point
/// of roughness and strength takes about 0.02 s; ranges of both, for a material with textures of both, 2 s of one core.
/// Computed at the first call and kept.
[[nodiscard]] const std::vector<glm::vec2>& anisotropicAlbedoTable(const AnisotropicSurface& surface,
                                                                   const FacetModel& model = {});

} // namespace isophote
