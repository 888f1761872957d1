// The sheen's lobe of shaders/bsdf/sheen.glsl in double precision, for the tables.
#pragma once

#include <cstdint>

#include "upload/layer_coupling.hpp"

namespace isophote {

/// The lobe of color 1.
struct SheenLobe {
  LayerRow albedo;       ///< of the lobe as it is evaluated
  LayerRow scale;        ///< of the published lobe, at wo and at wi
  LayerTransport shares; ///< of light of one node that go to another
};

/// The lobe of the table's row r, in [0, kLayerRoughnessCount): of roughness r' + (1 - r') (r / last)^2, r' the least.
[[nodiscard]] SheenLobe sheenLobe(uint32_t row);

} // namespace isophote
