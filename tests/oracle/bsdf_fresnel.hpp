// Fresnel reflectances in double precision.
#pragma once

#include <glm/glm.hpp>

namespace isophote::oracle {

/// Reflectance of unpolarized light at a smooth boundary between dielectrics: the mean of the squared s and p
/// amplitudes. Source: Born and Wolf 1999, "Principles of Optics", section 1.5.2, eq. 21.
/// @param cosI cosine on the incident side, in [0, 1]
/// @param eta  index behind the boundary over the index in front, > 0
[[nodiscard]] double fresnelDielectric(double cosI, double eta);

/// Schlick 1994, "An Inexpensive BRDF Model for Physically-based Rendering", eq. 15, with a free value at grazing.
[[nodiscard]] glm::dvec3 fresnelSchlick(const glm::dvec3& f0, const glm::dvec3& f90, double cosine);

} // namespace isophote::oracle
