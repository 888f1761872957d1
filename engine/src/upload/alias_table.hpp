// Walker's alias method: constant-time choice of one of n lights.
#pragma once

#include <span>
#include <vector>

#include "shared/light_types.h"

namespace isophote {

/// Builds the table for weights >= 0 (Vose 1991), in double. All weights zero, or none: an empty table.
/// Entry i's pmf is weights[i] / sum rounded to float.
[[nodiscard]] std::vector<gpu::AliasEntry> buildAliasTable(std::span<const double> weights);

} // namespace isophote
