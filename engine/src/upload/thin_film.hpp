// The thin film of shaders/bsdf/iridescence.glsl in double precision, for the tables. Formulas and sources there.
#pragma once

#include <glm/glm.hpp>

namespace isophote {

/// Reflectance, linear Rec.709 in [0, 1], of a surface of normal reflectance f0 under a film.
/// @param ior       of the film, at least 1
/// @param thickness nm
/// @param cosine    at the outer boundary, in [0, 1]
[[nodiscard]] glm::dvec3 thinFilmReflectance(double ior, double thickness, double cosine, const glm::dvec3& f0);

} // namespace isophote
