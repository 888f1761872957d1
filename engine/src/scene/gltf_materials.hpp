// glTF materials to Material, with their extensions.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "isophote/scene.hpp"
#include "scene/gltf_document.hpp"
#include "scene/gltf_textures.hpp"

namespace isophote::gltf {

/// Reads every material; TextureRef::texture still counts glTF textures. Values outside their range are clamped, with
/// one warning for each property.
[[nodiscard]] std::vector<Material> readMaterials(Document& document);

/// Puts the materials that are drawn into the scene, in order of first use.
class MaterialTable {
public:
  MaterialTable(Document& document, Textures& textures)
      : document_(document), materials_(readMaterials(document)), textures_(textures) {}

  /// The index in Scene::materials of a glTF material, or of the default material. Decodes its images on first use.
  [[nodiscard]] uint32_t use(std::optional<uint32_t> material, Scene& scene);

  /// A copy of the material without its normal texture, for primitives that cannot carry one.
  [[nodiscard]] uint32_t useWithoutNormalTexture(std::optional<uint32_t> material, Scene& scene);

private:
  [[nodiscard]] uint32_t add(std::optional<uint32_t> material, bool withNormalTexture, Scene& scene);

  const Document& document_;
  std::vector<Material> materials_;
  std::map<std::pair<std::optional<uint32_t>, bool>, uint32_t> used_; ///< (glTF index, with normal texture)
  Textures& textures_;
};

} // namespace isophote::gltf
