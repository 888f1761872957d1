// The tables behind shaders/bsdf/film_albedo.glsl.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "upload/facets.hpp"

namespace isophote {

/// A dielectric under a film: what a material with KHR_materials_iridescence can have, from .x to .y each.
struct FilmSurface {
  glm::vec3 f0{0.04f};    ///< normal reflectance of the dielectric
  float ior = 1.3f;       ///< of the film
  glm::vec2 thickness{0}; ///< nm
  glm::vec2 roughness{0, 1};
  bool operator==(const FilmSurface&) const = default;
};

/// Items of the surface's table.
[[nodiscard]] uint32_t filmAlbedoSize(const FilmSurface& surface);

/// Directional albedo, linear Rec.709, of isotropic facets that the film covers, one reflection, laid out as
/// shared/bsdf_constants.h says. One roughness takes milliseconds, a range of them 0.2 s. Computed at the first call
/// and kept.
[[nodiscard]] const std::vector<glm::vec3>& filmAlbedoTable(const FilmSurface& surface, const FacetModel& model = {});

} // namespace isophote
