// What one scattering by rough glass loses between its facets, in double precision.
#pragma once

#include <glm/glm.hpp>

namespace isophote::oracle {

/// 1 - reflected - transmitted of light that meets GGX facets of relative index eta at cosine mu; x: reflectance by the
/// Fresnel equations, y: only total internal reflection. By the midpoint rule over count^2 visible normals (Heitz
/// 2018); masking as in single scattering, G2 = 1 / (1 + Lambda(wo) + Lambda(wi)) to both sides.
[[nodiscard]] glm::dvec2 quadratureGlassLoss(double mu, double alpha, double eta, int count);

/// The same for facets of which KHR_materials_specular leaves the share `specular` of the reflectance, interpolated in
/// a table that is filled where it is read.
[[nodiscard]] double glassLoss(double mu, double alpha, double eta, double specular);

/// Its cosine-weighted mean over the hemisphere.
[[nodiscard]] double glassMeanLoss(double alpha, double eta, double specular);

} // namespace isophote::oracle
