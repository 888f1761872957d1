// The table behind shaders/bsdf/facet_albedo.glsl.
#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "upload/facets.hpp"

namespace isophote {

/// The integrals (A, B) of isotropic facets over outgoing cosine and roughness, laid out as shared/bsdf_constants.h
/// says, computed in double precision at the first call for a model (about 0.1 s) and kept.
///
/// A and B are the directional albedo's parts with Fresnel weights 1 - (1-c)^5 and (1-c)^5, c the cosine at the half
/// vector. Roughness 0 is the smooth mirror: A = 1 - (1-mu)^5, B = (1-mu)^5.
[[nodiscard]] const std::vector<glm::vec2>& facetAlbedoTable(const FacetModel& model = {});

/// The same with the way that the exact reflectance of index `ior` goes from normal to grazing, (F - R) / (1 - R),
/// instead of (1-c)^5.
/// @param ior at least 1; below, facetAlbedoTable
[[nodiscard]] const std::vector<glm::vec2>& exactAlbedoTable(const FacetModel& model, float ior);

} // namespace isophote
