// The tables behind shaders/bsdf/glass_loss.glsl.
#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "upload/facets.hpp"

namespace isophote {

/// A rough dielectric that transmits.
struct GlassSurface {
  float ior = 1.5f;          ///< in [1, 2^10]; clamped
  glm::vec2 roughness{0, 1}; ///< the table's rows are filled for lookups in [x, y]; others are 0
};

/// How its facets lie and reflect.
struct GlassModel {
  FacetModel facets;
  bool bySchlick = false;
};

/// What one scattering by rough glass in air loses: 1 - reflected - transmitted for lossless facets, over cosine and
/// roughness, from both sides. Layout: shared/bsdf_constants.h, the air's side first.
///
/// x counts facets that reflect as the model says; y those that reflect nothing below the critical angle. Masking is
/// the same for both sides. Computed at the first call and kept.
[[nodiscard]] const std::vector<glm::vec2>& glassLossTable(const GlassSurface& glass, const GlassModel& model = {});

} // namespace isophote
