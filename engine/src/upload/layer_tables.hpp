// The tables behind shaders/bsdf/layer.glsl: what a layer reflects, and how it couples with what lies below.
#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "upload/facets.hpp"

namespace isophote {

/// The clearcoat's table, laid out as shared/bsdf_constants.h says: facets of Schlick reflectance (kClearcoatF0, 1),
/// over a base of the same model. Computed in double precision at the first call for a model and kept.
[[nodiscard]] const std::vector<float>& clearcoatTable(const FacetModel& model = {});

/// The sheen's table: the Charlie lobe of color 1. Sources: shaders/bsdf/sheen.glsl.
[[nodiscard]] const std::vector<float>& sheenTable(const FacetModel& model = {});

/// What a sheen under a clearcoat does that neither does alone, laid out as shared/bsdf_constants.h says. Items:
/// - x what the coat takes from the sheen's light,
/// - y the coupling of both with facets over that of the coat alone,
/// - zw of the facets' A, B what leaves both,
/// and of means x and zw, there times A, B.
[[nodiscard]] const std::vector<glm::vec4>& coatedSheenTable(const FacetModel& model = {});

} // namespace isophote
