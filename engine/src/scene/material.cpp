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

std::optional<uint32_t> tangentUvSet(const Material& material) {
  if (material.normalTexture.present()) return material.normalTexture.uvSet;
  if (material.clearcoat.normalTexture.present()) return material.clearcoat.normalTexture.uvSet;
  if (material.anisotropy.strength > 0) return material.anisotropy.texture.uvSet;
  return std::nullopt;
}

bool isDispersive(const Material& material) {
  return material.dispersion > 0 && material.volume.thickness > 0 && material.ior > 1;
}

glm::vec3 channelIors(const Material& material) {
  const float halfSpread = isDispersive(material) ? (material.ior - 1) * 0.025f * material.dispersion : 0.0f;
  // Large dispersions would take red below the index of air.
  return glm::max(material.ior + halfSpread * glm::vec3(-1, 0, 1), glm::vec3(1));
}

} // namespace isophote
