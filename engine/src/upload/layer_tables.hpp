// The tables behind shaders/bsdf/layer.glsl: what a layer reflects, and how it couples with what lies below.
#pragma once

#include <vector>

namespace isophote {

/// The clearcoat's table, laid out as shared/bsdf_constants.h says: GGX of Schlick reflectance (kClearcoatF0, 1).
/// Computed in double precision at the first call and kept.
[[nodiscard]] const std::vector<float>& clearcoatTable();

/// The sheen's table: the Charlie lobe of color 1. Sources: shaders/bsdf/sheen.glsl.
[[nodiscard]] const std::vector<float>& sheenTable();

} // namespace isophote
