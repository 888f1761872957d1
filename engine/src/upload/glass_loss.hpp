// The tables behind shaders/bsdf/glass_loss.glsl.
#pragma once

#include <vector>

#include <glm/glm.hpp>

namespace isophote {

/// What one scattering by rough glass of index `ior` in air loses: 1 - reflected - transmitted for lossless facets,
/// over cosine and roughness, from both sides. Layout: shared/bsdf_constants.h, the air's side first.
///
/// x counts facets that reflect by the exact Fresnel equations; y those that reflect nothing below the critical angle.
/// Distribution and masking are those of ggxAlbedoTable, with the same correlated masking for both sides.
/// @param ior       in [1, 2^10]; clamped
/// @param roughness the table's rows are filled for lookups in [x, y]; others are 0
[[nodiscard]] std::vector<glm::vec2> glassLossTable(double ior, glm::dvec2 roughness = {0, 1});

} // namespace isophote
