// Textures and images, decoded when a material that is drawn first asks for them.
#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "isophote/scene.hpp"
#include "scene/gltf_buffers.hpp"
#include "scene/gltf_document.hpp"

namespace isophote::gltf {

class Textures {
public:
  Textures(Document& document, const Buffers& buffers) : document_(document), buffers_(buffers) {}

  /// Adds glTF texture `index` to the scene unless it is there, and returns its index in Scene::textures.
  ///
  /// kNone, after a warning, where it has no image that this build decodes.
  /// @throws SceneError at /images/N where the image is broken; LimitError where it is too large
  [[nodiscard]] int32_t use(uint32_t index, Scene& scene);

  /// The same for a texture with glossiness in its alpha, which becomes roughness. Not shared between materials.
  [[nodiscard]] int32_t useGlossiness(uint32_t index, float glossinessFactor, Scene& scene);

private:
  [[nodiscard]] std::optional<uint32_t> source(uint32_t index) const;
  [[nodiscard]] uint32_t useImage(uint32_t index, Scene& scene);
  [[nodiscard]] Texture readSampler(const Json& texture) const;

  Document& document_;
  const Buffers& buffers_;
  std::map<uint32_t, int32_t> textures_; ///< glTF index to scene index
  std::map<uint32_t, uint32_t> images_;
};

} // namespace isophote::gltf
