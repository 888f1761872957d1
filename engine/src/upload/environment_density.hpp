// The sampling density of an environment map.
#pragma once

#include <vector>

#include "isophote/scene.hpp"

namespace isophote {

/// Cumulative sums of a piecewise-constant density over the texels of an equirectangular map, see EnvironmentRecord.
struct EnvironmentDensity {
  std::vector<float> marginal;    ///< height + 1, from 0 to 1, multiples of 2^-24 like the sampler's numbers
  std::vector<float> conditional; ///< height rows of width + 1, from 0 to 1 (black rows: all 0), multiples of 2^-24
  double power = 0; ///< integral of luminance over the sphere, in W/(m^2); Environment::intensity is left out
};

/// The density follows the largest luminance in each texel's 3x3 neighbourhood times the solid angle of the texel:
/// wherever bilinear lookup is positive, so is the density. An all-black map gives empty arrays and power 0.
[[nodiscard]] EnvironmentDensity environmentDensity(const Environment& environment);

} // namespace isophote
