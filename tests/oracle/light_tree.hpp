// What a tree of lights should do, in angles and double precision.
#pragma once

#include <glm/glm.hpp>

#include "accel/light_tree.hpp"

namespace isophote::oracle {

/// Probability of light `index` for a receiver at `p` (world) with normal `ns` (0: none), from the tree's nodes.
/// Written from Conty Estevez and Kulla 2018, section 5: the importance is intensity * cos(theta') * |cos(theta_i')| /
/// d^2 with the angles reduced by the cluster's angular radius.
[[nodiscard]] double lightTreePmf(const LightTree& tree, uint32_t index, glm::dvec3 p, glm::dvec3 ns);

} // namespace isophote::oracle
