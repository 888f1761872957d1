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
#include "scene/gltf_variants.hpp"

namespace isophote::gltf {

class Meshes {
public:
  Meshes(Document& document, const Buffers& buffers, Accessors& accessors, MaterialTable& materials,
         const Variants& variants)
      : document_(document), buffers_(buffers), accessors_(accessors), materials_(materials), variants_(variants) {}

  /// The index in Scene::meshes of glTF mesh `index` in `pose`; nothing where it has no triangles.
  ///
  /// @param skinnedNode  the node where the pose has a skin: such meshes are not shared between nodes
  [[nodiscard]] std::optional<uint32_t> use(uint32_t index, std::optional<uint32_t> skinnedNode, const Pose& pose,
                                            Scene& scene);

private:
  [[nodiscard]] std::optional<Primitive> readPrimitive(const Json& json, const std::string& pointer, const Pose& pose,
                                                       Scene& scene);
  [[nodiscard]] std::vector<uint32_t> readTriangles(const Json& json, const std::string& pointer, uint64_t vertexCount);
  [[nodiscard]] std::vector<uint32_t> readIndices(const Json& json, const std::string& pointer, uint64_t vertexCount);
  void requireIndicesBelow(uint64_t vertexCount, const std::vector<uint32_t>& indices, const std::string& pointer,
                           std::optional<uint32_t> restart = std::nullopt) const;
  void clean(Primitive& primitive, const std::string& pointer);
  void assignMaterial(std::optional<uint32_t> material, const std::string& pointer, Primitive& primitive, Scene& scene);
  void fillMissingUvs(const std::string& pointer, Material& material, Primitive& primitive);

  using Key = std::tuple<uint32_t, std::optional<uint32_t>, std::vector<double>>; ///< mesh, node, morph weights

  Document& document_;
  const Buffers& buffers_;
  Accessors& accessors_; ///< compressed primitives put their data there
  MaterialTable& materials_;
  const Variants& variants_;
  std::map<Key, std::optional<uint32_t>> used_;
};

} // namespace isophote::gltf
