// Microfacets of any of the distributions in double precision, from the papers' definitions. Directions are unit, in
// the local shading frame, z up.
#pragma once

#include <glm/glm.hpp>

#include "isophote/settings.hpp"

namespace isophote::oracle {

struct FacetKind {
  Ndf ndf = Ndf::Ggx;
  Masking masking = Masking::Correlated;
};

/// Density of normals, per steradian. Sources: Walter et al. 2007, "Microfacet Models for Refraction through Rough
/// Surfaces", eq. 25, 30 and 33; Blinn-Phong's exponent is 2 / alpha^2 - 2. Where alpha differs along x and y, slopes
/// are stretched (Heitz 2014, JCGT 3(2), section 5.3).
[[nodiscard]] double facetD(Ndf ndf, const glm::dvec3& wm, const glm::dvec2& alpha);

/// Integral of D |dot(w, wm)| over normals, by quadrature of quantiles of their slopes: that Smith's masking is
/// G1 = 2 cos / (cos + this) makes the visible facets' projected area that of the surface (Heitz 2014, eq. 14 and 43).
[[nodiscard]] double projectedArea(Ndf ndf, const glm::dvec3& w, const glm::dvec2& alpha);

/// Masking of one direction by Smith's model.
[[nodiscard]] double facetG1(Ndf ndf, const glm::dvec3& w, const glm::dvec2& alpha);

/// Masking and shadowing: 1 / (1 + Lambda(wo) + Lambda(wi)) or G1(wo) G1(wi). Source: Heitz 2014, eq. 98 and 99.
[[nodiscard]] double facetG2(FacetKind kind, const glm::dvec3& wo, const glm::dvec3& wi, const glm::dvec2& alpha);

/// Density of the normals that wo sees, per steradian: of GGX by Smith's masking (Heitz 2014, eq. 16), else by that of
/// V-cavities, G1 = min(1, 2 cos(wm) cos(wo) / dot(wo, wm)) (Heitz and d'Eon 2014, "Importance Sampling
/// Microfacet-Based BSDFs using the Distribution of Visible Normals").
[[nodiscard]] double pdfFacetSeen(Ndf ndf, const glm::dvec3& wo, const glm::dvec3& wm, const glm::dvec2& alpha);

/// Integrals of D V cos over wi with Fresnel weights 1 - x and x, by `count` x 2 `count` normals of D cos.
/// @param exactIor x is (F - R) / (1 - R) of this index; below 1: Schlick's (1-c)^5
[[nodiscard]] glm::dvec2 facetAlbedo(FacetKind kind, const glm::dvec3& wo, const glm::dvec2& alpha, int count,
                                     double exactIor = 0);

} // namespace isophote::oracle
