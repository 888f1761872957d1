#include "scene/gltf_instances.hpp"

#include <algorithm>
#include <optional>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include "isophote/error.hpp"
#include "scene/gltf_pose.hpp"

namespace isophote::gltf {
namespace {

class InstanceBuilder {
public:
  InstanceBuilder(Document& document, const Accessors& accessors, const NodeGraph& graph, Meshes& meshes, Scene& scene)
      : document_(document), accessors_(accessors), graph_(graph), meshes_(meshes), scene_(scene),
        nodes_(arrayOrEmpty(document.root, "nodes")) {}

  void add(const PlacedNode& node) {
    const Json& json = nodes_[node.index];
    const std::optional<uint32_t> mesh = indexOf(json, "mesh");
    if (!mesh) return;
    Pose pose{.morphWeights = morphWeights(json, *mesh)};
    const std::optional<uint32_t> skin = indexOf(json, "skin");
    if (skin) {
      const glm::dmat4 worldFromObject = setSkin(*skin, node, pose);
      addOne(node.index, meshes_.use(*mesh, node.index, pose, scene_), worldFromObject);
      return;
    }
    const std::optional<uint32_t> used = meshes_.use(*mesh, std::nullopt, pose, scene_);
    if (const Json* instancing = extension(json, "EXT_mesh_gpu_instancing")) {
      addMany(node, used, instancing->at("attributes"));
    } else {
      addOne(node.index, used, node.worldFromNode);
    }
  }

private:
  /// Without trailing zeros, so that equal poses compare equal.
  std::vector<double> morphWeights(const Json& node, uint32_t mesh) const {
    const Json* weights = member(node, "weights");
    if (!weights) weights = member(arrayOrEmpty(document_.root, "meshes")[mesh], "weights");
    std::vector<double> result = weights ? weights->get<std::vector<double>>() : std::vector<double>{};
    while (!result.empty() && result.back() == 0) result.pop_back();
    return result;
  }

  /// Object space of a skinned mesh is world space moved to its first joint, so that single precision suffices far
  /// from the origin. glTF: the transform of the node itself has no influence.
  glm::dmat4 setSkin(uint32_t skin, const PlacedNode& node, Pose& pose) {
    if (jointWorlds_.empty()) jointWorlds_ = graph_.worldTransforms();
    const Json& json = arrayOrEmpty(document_.root, "skins")[skin];
    const Json& joints = json.at("joints");
    const std::vector<glm::mat4> inverseBinds = inverseBindMatrices(json, joints.size(), skin);
    const glm::dvec3 origin(jointWorlds_[joints[0].get<uint32_t>()][3]);
    const glm::dmat4 objectFromWorld = glm::translate(glm::dmat4(1), -origin);
    for (size_t i = 0; i < joints.size(); ++i) {
      glm::dmat4 matrix = objectFromWorld * jointWorlds_[joints[i].get<uint32_t>()];
      if (!inverseBinds.empty()) matrix = matrix * glm::dmat4(inverseBinds[i]);
      pose.objectFromBind.push_back(matrix);
    }
    pose.objectFromUnskinned = objectFromWorld * node.worldFromNode;
    return glm::translate(glm::dmat4(1), origin);
  }

  /// Empty: all are the identity.
  std::vector<glm::mat4> inverseBindMatrices(const Json& skin, size_t jointCount, uint32_t index) const {
    const std::optional<uint32_t> accessor = indexOf(skin, "inverseBindMatrices");
    if (!accessor) return {};
    const std::string pointer = fmt::format("/skins/{}/inverseBindMatrices", index);
    requireFormat(document_, accessors_, *accessor, 16, kFloat, pointer);
    if (accessors_.layout(*accessor).count < jointCount) {
      document_.fail(pointer,
                     fmt::format("a matrix for each of the {} joints (INVALID_IBM_ACCESSOR_COUNT)", jointCount));
    }
    return accessors_.readFloats<glm::mat4>(*accessor);
  }

  void addMany(const PlacedNode& node, std::optional<uint32_t> mesh, const Json& attributes) {
    const std::string pointer = nodePointer(node.index) + "/extensions/EXT_mesh_gpu_instancing/attributes";
    const auto count = instanceCount(attributes, pointer);
    const auto translations = readAs<glm::vec3>(attributes, "TRANSLATION", 3, kFloat, pointer);
    const auto rotations = readAs<glm::vec4>(attributes, "ROTATION", 4, kFloat | kSignedNormalized, pointer);
    const auto scales = readAs<glm::vec3>(attributes, "SCALE", 3, kFloat, pointer);
    for (uint64_t i = 0; i < count; ++i) {
      const glm::dvec3 translation(translations.empty() ? glm::vec3(0) : translations[i]);
      const glm::dvec4 rotation(rotations.empty() ? glm::vec4(0, 0, 0, 1) : rotations[i]);
      const glm::dvec3 scale(scales.empty() ? glm::vec3(1) : scales[i]);
      addOne(node.index, mesh, node.worldFromNode * transformFrom(translation, rotation, scale));
    }
  }

  uint64_t instanceCount(const Json& attributes, const std::string& pointer) const {
    std::optional<uint64_t> count;
    for (const char* name : {"TRANSLATION", "ROTATION", "SCALE"}) {
      const std::optional<uint32_t> accessor = indexOf(attributes, name);
      if (!accessor) continue;
      const uint64_t here = accessors_.layout(*accessor).count;
      if (count && *count != here) document_.fail(pointer, "attributes with equal counts");
      count = here;
    }
    return count.value_or(1);
  }

  template <class Vector>
  std::vector<Vector> readAs(const Json& attributes, const char* name, uint32_t components, uint32_t kinds,
                             const std::string& pointer) const {
    const std::optional<uint32_t> accessor = indexOf(attributes, name);
    if (!accessor) return {};
    requireFormat(document_, accessors_, *accessor, components, kinds, fmt::format("{}/{}", pointer, name));
    return accessors_.readFloats<Vector>(*accessor);
  }

  void addOne(uint32_t node, std::optional<uint32_t> mesh, const glm::dmat4& worldFromObject) {
    if (!mesh) return;
    if (isSingular(worldFromObject)) {
      document_.warnings.add("a mesh under a singular transform is skipped", nodePointer(node));
      return;
    }
    if (scene_.instances.size() >= document_.options.maxNodes) {
      throw LimitError(
          fmt::format("{}: {}: more than {} instances", document_.file, nodePointer(node), document_.options.maxNodes));
    }
    scene_.instances.push_back({*mesh, worldFromObject, stringOr(nodes_[node], "name", "")});
  }

  Document& document_;
  const Accessors& accessors_;
  const NodeGraph& graph_;
  Meshes& meshes_;
  Scene& scene_;
  const Json& nodes_;
  std::vector<glm::dmat4> jointWorlds_; ///< of all nodes, once a skin is met
};

} // namespace

void addInstances(Document& document, const Accessors& accessors, const NodeGraph& graph,
                  const std::vector<PlacedNode>& nodes, Meshes& meshes, Scene& scene) {
  InstanceBuilder builder(document, accessors, graph, meshes, scene);
  for (const PlacedNode& node : nodes) {
    if (node.visible) builder.add(node);
  }
}

} // namespace isophote::gltf
