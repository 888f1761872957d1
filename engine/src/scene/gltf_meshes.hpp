// glTF meshes to Mesh: triangle lists with everything a material needs.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "isophote/scene.hpp"
#include "scene/gltf_accessors.hpp"
#include "scene/gltf_document.hpp"
#include "scene/gltf_materials.hpp"
#include "scene/gltf_pose.hpp"

namespace isophote::gltf {

class Meshes {
public:
  Meshes(Document& document, const Accessors& accessors, MaterialTable& materials)
      : document_(document), accessors_(accessors), materials_(materials) {}

  /// The index in Scene::meshes of glTF mesh `index` in `pose`; nothing where it has no triangles.
  ///
  /// @param skinnedNode  the node where the pose has a skin: such meshes are not shared between nodes
  [[nodiscard]] std::optional<uint32_t> use(uint32_t index, std::optional<uint32_t> skinnedNode, const Pose& pose,
                                            Scene& scene);

private:
  [[nodiscard]] std::optional<Primitive> readPrimitive(const Json& json, const std::string& pointer, const Pose& pose,
                                                       Scene& scene);
  [[nodiscard]] std::vector<uint32_t> readIndices(const Json& json, const std::string& pointer, uint64_t vertexCount);
  void clean(Primitive& primitive, const std::string& pointer);
  void assignMaterial(std::optional<uint32_t> material, const std::string& pointer, Primitive& primitive, Scene& scene);
  void fillMissingUvs(const std::string& pointer, Material& material, Primitive& primitive);

  using Key = std::tuple<uint32_t, std::optional<uint32_t>, std::vector<double>>; ///< mesh, node, morph weights

  Document& document_;
  const Accessors& accessors_;
  MaterialTable& materials_;
  std::map<Key, std::optional<uint32_t>> used_;
};

} // namespace isophote::gltf
