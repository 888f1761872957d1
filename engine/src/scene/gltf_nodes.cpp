// Source: Khronos glTF 2.0.1 specification, section 3.5 "Scenes" and 3.5.3 "Transformations".
#include "scene/gltf_nodes.hpp"

#include <cmath>
#include <numeric>
#include <set>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "isophote/error.hpp"

namespace isophote::gltf {
namespace {

template <class Vector> Vector vectorOr(const Json& object, const char* name, Vector fallback) {
  const Json* values = member(object, name);
  if (!values) return fallback;
  Vector result;
  for (int i = 0; i < Vector::length(); ++i) result[i] = (*values)[static_cast<size_t>(i)].get<double>();
  return result;
}

bool isFinite(const glm::dmat4& m) {
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 4; ++r) {
      if (!std::isfinite(m[c][r])) return false;
    }
  }
  return true;
}

glm::dmat4 readMatrix(const Json& values) {
  glm::dmat4 matrix;
  for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = values[static_cast<size_t>(i)].get<double>();
  return matrix;
}

glm::dvec4 lastRow(const glm::dmat4& matrix) { return {matrix[0][3], matrix[1][3], matrix[2][3], matrix[3][3]}; }

glm::dvec4 readRotation(const Json& node) { return vectorOr(node, "rotation", glm::dvec4(0, 0, 0, 1)); }

} // namespace

std::string nodePointer(uint32_t node) { return fmt::format("/nodes/{}", node); }

bool isSingular(const glm::dmat4& transform) {
  if (!isFinite(transform)) return true;
  constexpr double kSmallest = 1e-30;
  constexpr double kLargest = 1e30;
  constexpr double kFlat = 1e-12; // of the volume that axes of those lengths would span at right angles
  if (glm::length(glm::dvec3(transform[3])) > kLargest) return true;
  const glm::dmat3 linear(transform);
  double volume = 1;
  for (int c = 0; c < 3; ++c) {
    const double length = glm::length(linear[c]);
    if (!(length >= kSmallest && length <= kLargest)) return true;
    volume *= length;
  }
  return !(std::abs(glm::determinant(linear)) > kFlat * volume);
}

glm::dmat4 transformFrom(glm::dvec3 translation, glm::dvec4 rotation, glm::dvec3 scale) {
  const double length = glm::length(rotation);
  glm::dquat quaternion(1, 0, 0, 0);
  if (length > 0)
    quaternion = glm::dquat(rotation.w / length, rotation.x / length, rotation.y / length, rotation.z / length);
  return glm::translate(glm::dmat4(1), translation) * glm::mat4_cast(quaternion) * glm::scale(glm::dmat4(1), scale);
}

NodeGraph::NodeGraph(Document& document) : document_(document), nodes_(arrayOrEmpty(document.root, "nodes")) {
  if (nodes_.size() > document.options.maxNodes) {
    throw LimitError(
        fmt::format("{}: /nodes: {} nodes, the limit is {}", document.file, nodes_.size(), document.options.maxNodes));
  }
  findParents();
  refuseLoops();
  for (uint32_t i = 0; i < nodes_.size(); ++i) checkTransform(i);
}

void NodeGraph::findParents() {
  parents_.assign(nodes_.size(), -1);
  for (size_t i = 0; i < nodes_.size(); ++i) {
    const Json& children = arrayOrEmpty(nodes_[i], "children");
    for (size_t c = 0; c < children.size(); ++c) {
      const auto child = children[c].get<uint32_t>();
      if (parents_[child] >= 0) {
        document_.fail(fmt::format("/nodes/{}/children/{}", i, c),
                       fmt::format("a node without another parent, node {} is already a child of node {} "
                                   "(NODE_PARENT_OVERRIDE)",
                                   child, parents_[child]));
      }
      parents_[child] = static_cast<int64_t>(i);
    }
  }
}

/// With one parent each, a node that is in a loop or hangs from one never reaches a root on its way up.
void NodeGraph::refuseLoops() const {
  constexpr uint32_t kUnknown = 0;
  constexpr uint32_t kReachesRoot = UINT32_MAX;
  std::vector<uint32_t> state(nodes_.size(), kUnknown); // otherwise: the walk that met it, from 1
  for (uint32_t start = 0; start < state.size(); ++start) {
    const uint32_t walk = start + 1;
    int64_t node = start;
    while (node >= 0 && state[static_cast<size_t>(node)] == kUnknown) {
      state[static_cast<size_t>(node)] = walk;
      node = parents_[static_cast<size_t>(node)];
    }
    if (node >= 0 && state[static_cast<size_t>(node)] == walk) {
      document_.fail(nodePointer(static_cast<uint32_t>(node)), "a node that is not its own ancestor (NODE_LOOP)");
    }
    for (node = start; node >= 0 && state[static_cast<size_t>(node)] == walk;
         node = parents_[static_cast<size_t>(node)]) {
      state[static_cast<size_t>(node)] = kReachesRoot;
    }
  }
}

std::vector<uint32_t> NodeGraph::allRoots() const {
  std::vector<uint32_t> roots;
  for (uint32_t i = 0; i < parents_.size(); ++i) {
    if (parents_[i] < 0) roots.push_back(i);
  }
  return roots;
}

std::vector<uint32_t> NodeGraph::sceneRoots() const {
  const Json& scenes = arrayOrEmpty(document_.root, "scenes");
  if (document_.options.scene && *document_.options.scene >= scenes.size()) {
    document_.fail("/scenes", fmt::format("a scene {}, there are {}", *document_.options.scene, scenes.size()));
  }
  if (scenes.empty()) return allRoots();
  const uint32_t chosen = document_.options.scene.value_or(indexOf(document_.root, "scene").value_or(0));
  const Json& nodes = arrayOrEmpty(scenes[chosen], "nodes");
  std::vector<uint32_t> roots;
  std::set<uint32_t> seen;
  for (size_t i = 0; i < nodes.size(); ++i) {
    const auto node = nodes[i].get<uint32_t>();
    const std::string pointer = fmt::format("/scenes/{}/nodes/{}", chosen, i);
    if (parents_[node] >= 0)
      document_.fail(pointer, fmt::format("a root node, node {} has a parent (SCENE_NON_ROOT_NODE)", node));
    if (!seen.insert(node).second) document_.fail(pointer, fmt::format("every node once, node {} is repeated", node));
    roots.push_back(node);
  }
  return roots;
}

std::vector<PlacedNode> NodeGraph::place(const std::vector<uint32_t>& roots) const {
  std::vector<PlacedNode> result;
  std::vector<PlacedNode> open; // parents' transforms until a node is taken out
  for (auto root = roots.rbegin(); root != roots.rend(); ++root) open.push_back({.index = *root});
  while (!open.empty()) {
    PlacedNode node = open.back();
    open.pop_back();
    const Json& json = nodes_[node.index];
    node.worldFromNode = node.worldFromNode * localTransform(node.index);
    if (!isFinite(node.worldFromNode)) document_.fail(nodePointer(node.index), "a finite transform");
    if (const Json* visibility = extension(json, "KHR_node_visibility")) {
      node.visible = node.visible && boolOr(*visibility, "visible", true);
    }
    result.push_back(node);
    const Json& children = arrayOrEmpty(json, "children");
    for (size_t c = children.size(); c-- > 0;) {
      open.push_back({children[c].get<uint32_t>(), node.worldFromNode, node.visible});
    }
  }
  return result;
}

std::vector<glm::dmat4> NodeGraph::worldTransforms() const {
  std::vector<glm::dmat4> result(nodes_.size(), glm::dmat4(1));
  for (const PlacedNode& node : place(allRoots())) result[node.index] = node.worldFromNode;
  return result;
}

void NodeGraph::checkTransform(uint32_t node) {
  const Json& json = nodes_[node];
  if (const Json* values = member(json, "matrix")) {
    constexpr double kTolerance = 1e-6; // exporters write single precision
    if (glm::length(lastRow(readMatrix(*values)) - glm::dvec4(0, 0, 0, 1)) > kTolerance) {
      document_.fail(nodePointer(node) + "/matrix", "an affine matrix with the last row 0 0 0 1");
    }
    if (json.contains("translation") || json.contains("rotation") || json.contains("scale")) {
      document_.warnings.add("translation, rotation and scale beside a matrix are ignored", nodePointer(node));
    }
  } else {
    constexpr double kUnitTolerance = 1e-3; // as far as normalized 16-bit integers and text exporters are off
    if (std::abs(glm::length(readRotation(json)) - 1) > kUnitTolerance) {
      document_.warnings.add("rotations that are not unit quaternions are normalized", nodePointer(node));
    }
  }
}

glm::dmat4 NodeGraph::localTransform(uint32_t node) const {
  const Json& json = nodes_[node];
  if (const Json* values = member(json, "matrix")) {
    glm::dmat4 matrix = readMatrix(*values);
    for (int c = 0; c < 4; ++c) matrix[c][3] = c == 3 ? 1 : 0; // checked to be almost that
    return matrix;
  }
  return transformFrom(vectorOr(json, "translation", glm::dvec3(0)), readRotation(json),
                       vectorOr(json, "scale", glm::dvec3(1)));
}

} // namespace isophote::gltf
