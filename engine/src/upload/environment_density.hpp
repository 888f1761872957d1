// The sampling density of an environment map.
#pragma once

#include <vector>

#include "isophote/scene.hpp"

namespace isophote {

/// Cumulative sums of the probabilities of an equirectangular map's cells, see EnvironmentRecord.
struct EnvironmentDensity {
  std::vector<float> marginal;    ///< height + 2, from 0 to 1, multiples of 2^-24 like the sampler's numbers
  std::vector<float> conditional; ///< height + 1 rows of width + 1, from 0 to 1 (black rows: all 0), multiples of 2^-24
  double power = 0; ///< integral of luminance over the sphere, in W/(m^2); Environment::intensity is left out
};

/// A cell lies between the centers of four texels, where bilinear lookup mixes them, and has the mean of their
/// luminances times its solid angle; within it the shader follows the mixture. Wherever lookup is positive, so is the
/// density. An all-black map gives empty arrays and power 0.
[[nodiscard]] EnvironmentDensity environmentDensity(const Environment& environment);

} // namespace isophote
