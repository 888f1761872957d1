// The tables behind shaders/bsdf/layer.glsl: what a layer reflects, and how it couples with what lies below.
#pragma once

#include <vector>

#include "upload/facets.hpp"

namespace isophote {

/// The clearcoat's table, laid out as shared/bsdf_constants.h says: facets of Schlick reflectance (kClearcoatF0, 1),
/// over a base of the same model. Computed in double precision at the first call for a model and kept.
[[nodiscard]] const std::vector<float>& clearcoatTable(const FacetModel& model = {});

/// The sheen's table: the Charlie lobe of color 1. Sources: shaders/bsdf/sheen.glsl.
[[nodiscard]] const std::vector<float>& sheenTable(const FacetModel& model = {});

} // namespace isophote
