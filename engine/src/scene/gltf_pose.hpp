// The static pose of a mesh: morph weights and joint matrices, applied to its vertices once at load time.
#pragma once

#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "scene/gltf_attributes.hpp"

namespace isophote::gltf {

struct Pose {
  std::vector<double> morphWeights;       ///< one a target; missing ones are 0
  std::vector<glm::dmat4> objectFromBind; ///< one a joint; empty: no skin
  glm::dmat4 objectFromUnskinned{1};      ///< with a skin: for primitives that have no joints
};

/// Adds the weighted targets of `primitive`. @throws SceneError
void applyMorphTargets(const Document& document, const Accessors& accessors, const Json& primitive, const Pose& pose,
                       const std::string& pointer, Primitive& vertices);

/// Blends the joint matrices linearly at every vertex. Weights are normalized; bad ones count as 0, with a warning.
/// @throws SceneError where a joint with weight is not in the skin
void applySkin(Document& document, const Pose& pose, const std::string& pointer, Attributes& attributes);

} // namespace isophote::gltf
