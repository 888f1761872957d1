// Reads one property of a glTF material: its range, its texture.
#pragma once

#include <string>

#include <glm/glm.hpp>

#include "isophote/scene.hpp"
#include "scene/gltf_document.hpp"

namespace isophote::gltf {

/// Values outside their range are clamped, with one warning for each property. References must outlive the reader.
class MaterialProperties {
public:
  MaterialProperties(Document& document, const std::string& pointer) : document_(document), pointer_(pointer) {}

  /// `value` in [lower, upper]; `name` is for the warning.
  [[nodiscard]] float clamped(const Json& value, const char* name, float lower, float upper);
  [[nodiscard]] float factor(const Json& object, const char* name, float fallback, float lower, float upper);
  /// Channels in [0, upper].
  [[nodiscard]] glm::vec3 color(const Json& object, const char* name, glm::vec3 fallback, float upper);
  /// A textureInfo with its KHR_texture_transform; TextureRef::texture counts glTF textures.
  [[nodiscard]] TextureRef texture(const Json& object, const char* name);

private:
  Document& document_;
  const std::string& pointer_;
};

} // namespace isophote::gltf
