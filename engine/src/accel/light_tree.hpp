// A hierarchy over lights for choosing one by what it can do at a point: a pure function of the lights' bounds.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "shared/light_types.h"

namespace isophote {

/// What a choice among lights may assume of one light. Light leaves it within `thetaO + thetaE` of `axis`, at an angle
/// of theta beyond thetaO with at most cos(theta) times the intensity.
struct LightBound {
  glm::dvec3 lower{0}; ///< box that holds the light
  glm::dvec3 upper{0};
  glm::dvec3 axis{0, 1, 0}; ///< unit
  double thetaO = 0;        ///< radians, [0, pi]: half angle of the cone of normals
  double thetaE = 0;        ///< radians, [0, pi / 2]: emission about each normal
  bool twoSided = false;    ///< the same about -axis
  double intensity = 0;     ///< largest, W/sr (luminance); 0: the light is left out
  bool infinite = false;    ///< no place: only `power` counts
  double power = 0;         ///< W
};

/// Nodes in the order of gpu::LightTreeNode, root first; nothing where no light has intensity or power.
struct LightTree {
  std::vector<gpu::LightTreeNode> nodes;
  std::vector<uint32_t>
      trails;      ///< one per light: bit d is the child to take at depth d; kNoLightTrail: not in the tree
  float scale = 1; ///< from world lengths to the tree's
};

/// Builds the tree by the surface area orientation heuristic. Infinite lights make a subtree of fixed probabilities
/// beside the others. Equal input gives equal output.
///
/// Source: Conty Estevez and Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree Splitting", sections
/// 4.2 to 4.4.
/// @param lights  in the order of light indices, fewer than gpu::kLightTreeMaxLights
[[nodiscard]] LightTree buildLightTree(std::span<const LightBound> lights);

} // namespace isophote
