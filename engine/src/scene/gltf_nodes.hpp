// The node hierarchy: checked, placed in double precision, and walked without recursion.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "scene/gltf_document.hpp"

namespace isophote::gltf {

/// A node of the chosen scene.
struct PlacedNode {
  uint32_t index = 0;
  glm::dmat4 worldFromNode{1};
  bool visible = true; ///< by KHR_node_visibility of itself and everything above
};

class NodeGraph {
public:
  /// Checks that the nodes are a forest and their transforms affine.
  /// @throws SceneError on loops, nodes with two parents and projective matrices; LimitError on too many nodes
  explicit NodeGraph(Document& document);

  /// Indices of the root nodes of the chosen scene: LoadOptions::scene, the asset's default, the first, or where there
  /// are no scenes every node without a parent. @throws SceneError
  [[nodiscard]] std::vector<uint32_t> sceneRoots() const;

  /// `roots` and all below them, parents before children, in file order.
  /// @throws SceneError where a product of transforms is not finite
  [[nodiscard]] std::vector<PlacedNode> place(const std::vector<uint32_t>& roots) const;

  /// World transforms of all nodes of the document, by index: joints may lie outside of the chosen scene.
  [[nodiscard]] std::vector<glm::dmat4> worldTransforms() const;

private:
  void findParents();
  void refuseLoops() const;
  void checkTransform(uint32_t node);
  [[nodiscard]] std::vector<uint32_t> allRoots() const;
  [[nodiscard]] glm::dmat4 localTransform(uint32_t node) const;

  Document& document_;
  const Json& nodes_;
  std::vector<int64_t> parents_; ///< -1: none
};

/// `/nodes/N`
[[nodiscard]] std::string nodePointer(uint32_t node);

/// A transform that cannot be undone in single precision: a squashed axis, a scale outside of 1e-30 to 1e30, a
/// translation above 1e30, or anything not finite.
[[nodiscard]] bool isSingular(const glm::dmat4& transform);

/// translation * rotation * scale; the quaternion is (x, y, z, w) and need not be unit. A zero one counts as none.
[[nodiscard]] glm::dmat4 transformFrom(glm::dvec3 translation, glm::dvec4 rotation, glm::dvec3 scale);

} // namespace isophote::gltf
