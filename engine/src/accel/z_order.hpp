// Boxes along a curve on which neighbors are neighbors in space.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "accel/bvh.hpp"

namespace isophote {

/// Numbers of the boxes by the place of their centers along a Z-order curve of 2^21 cells an axis that fills the bounds
/// of all; those of one cell keep their order. Boxes must be finite.
///
/// Source: Morton 1966, "A computer oriented geodetic data base and a new technique in file sequencing", IBM.
/// @param threads  0: all cores; the result does not depend on it
[[nodiscard]] std::vector<uint32_t> zOrder(std::span<const Box> boxes, uint32_t threads = 0);

} // namespace isophote
