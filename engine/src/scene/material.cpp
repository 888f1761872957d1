#include "isophote/scene.hpp"

namespace isophote {

std::vector<TextureRef*> textureRefs(Material& m) {
  return {&m.baseColorTexture,
          &m.metallicRoughnessTexture,
          &m.normalTexture,
          &m.emissiveTexture,
          &m.specularTexture,
          &m.specularColorTexture,
          &m.clearcoat.texture,
          &m.clearcoat.roughnessTexture,
          &m.clearcoat.normalTexture,
          &m.sheen.colorTexture,
          &m.sheen.roughnessTexture,
          &m.anisotropy.texture,
          &m.iridescence.texture,
          &m.iridescence.thicknessTexture,
          &m.transmission.texture,
          &m.diffuseTransmission.texture,
          &m.diffuseTransmission.colorTexture,
          &m.volume.thicknessTexture};
}

std::vector<const TextureRef*> textureRefs(const Material& material) {
  const std::vector<TextureRef*> refs = textureRefs(const_cast<Material&>(material));
  return {refs.begin(), refs.end()};
}

} // namespace isophote
