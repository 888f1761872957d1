// Anisotropic GGX in double precision, from the papers' formulas. Directions are unit, in the local shading frame, z
// up.
#pragma once

#include <glm/glm.hpp>

namespace isophote::oracle {

/// Normal distribution, per steradian. Source: Heitz 2014, "Understanding the Masking-Shadowing Function in
/// Microfacet-Based BRDFs", JCGT 3(2), eq. 84.
[[nodiscard]] double ggxD(const glm::dvec3& wm, const glm::dvec2& alpha);

/// Masking of one direction by Smith's model. Source: Heitz 2014, eq. 43 and 86.
[[nodiscard]] double ggxG1(const glm::dvec3& w, const glm::dvec2& alpha);

/// Height-correlated masking and shadowing, 1 / (1 + Lambda(wo) + Lambda(wi)). Source: Heitz 2014, eq. 99.
[[nodiscard]] double ggxG2(const glm::dvec3& wo, const glm::dvec3& wi, const glm::dvec2& alpha);

/// Density of visible normals, per steradian of wm. Source: Heitz 2014, eq. 16.
[[nodiscard]] double pdfVisibleNormal(const glm::dvec3& wo, const glm::dvec3& wm, const glm::dvec2& alpha);

/// A visible normal. Source: Heitz 2018, "Sampling the GGX Distribution of Visible Normals", JCGT 7(4), listing 1.
[[nodiscard]] glm::dvec3 sampleVisibleNormal(const glm::dvec3& wo, const glm::dvec2& alpha, const glm::dvec2& u);

/// Directional albedo of isotropic GGX split by Schlick's weights: x is the integral of D V cos with Fresnel factor
/// 1 - (1-c)^5, y with (1-c)^5, so that the albedo is f0 x + f90 y. By quadrature over `count`^2 visible normals.
/// @param mu    cosine of wo, in [0, 1]
/// @param alpha in [0, 1]; 0 is the smooth mirror
[[nodiscard]] glm::dvec2 quadratureAlbedo(double mu, double alpha, int count);

/// The same from a fine table that fills itself row by row where it is asked, by cubic interpolation. Error below 3e-4,
/// and 1e-3 where alpha and mu are both below 0.01.
/// Safe to call from several threads.
[[nodiscard]] glm::dvec2 directionalAlbedo(double mu, double alpha);

/// (A, B) of anisotropic GGX for w, by quadrature at 33 values of sqrt(mu) and 17 of the azimuth, read bilinearly. Safe
/// to call from several threads.
[[nodiscard]] glm::dvec2 anisotropicAlbedo(const glm::dvec3& w, const glm::dvec2& alpha);

/// Its cosine-weighted mean.
[[nodiscard]] glm::dvec2 anisotropicMeanAlbedo(const glm::dvec2& alpha);

/// Cosine-weighted mean over the hemisphere, 2 times the integral of directionalAlbedo(mu) mu over mu in [0, 1].
[[nodiscard]] glm::dvec2 meanAlbedo(double alpha);

} // namespace isophote::oracle
