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

/// Reflectance of unpolarized light at a conductor, from complex amplitudes. Source: Born and Wolf 1999, "Principles of
/// Optics", section 14.2: Fresnel's equations with a complex index.
/// @param n, k complex index n + ik over the index in front
[[nodiscard]] double fresnelConductor(double cosI, double n, double k);

/// A thin film over a surface.
struct ThinFilm {
  double amount = 0;
  double ior = 1.3;
  double thickness = 0; ///< nm
};

/// Reflectance of the film over normal reflectance f0, linear Rec.709. Source: Belcour and Barla 2017, "A Practical
/// Extension to Microfacet Theory for the Modeling of Varying Iridescence", eq. 6 to 10, as simplified in
/// KHR_materials_iridescence.
[[nodiscard]] glm::dvec3 filmReflectance(const ThinFilm& film, double cosine, const glm::dvec3& f0);

/// The smallest f0 of a Schlick reflectance (f0, 1) above the film's brightest channel at the cosines (i / 8)^1.5, i =
/// 1 to 8.
[[nodiscard]] double filmBound(const ThinFilm& film, const glm::dvec3& f0);

} // namespace isophote::oracle
