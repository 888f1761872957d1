#include "upload/pack_materials.hpp"

#include <map>
#include <tuple>

namespace isophote {
namespace {

class MaterialPacker {
public:
  MaterialPacker(const Scene& scene, PackedScene& packed) : scene_(scene), packed_(packed) {}

  // Appends a record and returns the texture coordinate sets it reads.
  uint32_t add(const Material& material) {
    uvSets_ = 0;
    gpu::MaterialRecord record{};
    setBase(material, record);
    setLayers(material, record);
    setInterior(material, record);
    packed_.materials.push_back(record);
    return uvSets_;
  }

private:
  void setBase(const Material& material, gpu::MaterialRecord& record) {
    record.baseColor = material.baseColor;
    record.emissive = isEmitter(material) ? material.emissive : glm::vec3(0);
    record.metallic = material.metallic;
    record.specularColor = material.specularColor;
    record.roughness = material.roughness;
    record.specular = material.specular;
    record.ior = material.ior;
    record.dispersion = material.dispersion;
    record.alphaCutoff = material.alphaCutoff;
    record.alphaMode = static_cast<uint32_t>(material.alphaMode);
    record.flags = (material.doubleSided ? gpu::kMaterialDoubleSided : 0) | (material.unlit ? gpu::kMaterialUnlit : 0);
    record.baseColorSlot = slot(material.baseColorTexture, true);
    record.metallicRoughnessSlot = slot(material.metallicRoughnessTexture, false);
    record.normalSlot = slot(material.normalTexture, false);
    record.emissiveSlot = isEmitter(material) ? slot(material.emissiveTexture, true) : gpu::kInvalidIndex;
    record.specularSlot = slot(material.specularTexture, false);
    record.specularColorSlot = slot(material.specularColorTexture, true);
  }

  // What lies on the base, and what bends its specular lobe.
  void setLayers(const Material& material, gpu::MaterialRecord& record) {
    const Clearcoat& clearcoat = material.clearcoat;
    record.clearcoat = clearcoat.factor;
    record.clearcoatRoughness = clearcoat.roughness;
    record.clearcoatSlot = slot(clearcoat.texture, false);
    record.clearcoatRoughnessSlot = slot(clearcoat.roughnessTexture, false);
    record.clearcoatNormalSlot = slot(clearcoat.normalTexture, false);
    const Sheen& sheen = material.sheen;
    record.sheenColor = sheen.color;
    record.sheenRoughness = sheen.roughness;
    record.sheenColorSlot = slot(sheen.colorTexture, true);
    record.sheenRoughnessSlot = slot(sheen.roughnessTexture, false);
    const Anisotropy& anisotropy = material.anisotropy;
    record.anisotropyStrength = anisotropy.strength;
    record.anisotropyRotation = anisotropy.rotation;
    record.anisotropySlot = slot(anisotropy.texture, false);
    const Iridescence& iridescence = material.iridescence;
    record.iridescence = iridescence.factor;
    record.iridescenceIor = iridescence.ior;
    record.iridescenceThicknessMinimum = iridescence.thicknessMinimum;
    record.iridescenceThicknessMaximum = iridescence.thicknessMaximum;
    record.iridescenceSlot = slot(iridescence.texture, false);
    record.iridescenceThicknessSlot = slot(iridescence.thicknessTexture, false);
  }

  // What passes through the surface, and what it passes into.
  void setInterior(const Material& material, gpu::MaterialRecord& record) {
    record.transmission = material.transmission.factor;
    record.transmissionSlot = slot(material.transmission.texture, false);
    const DiffuseTransmission& diffuse = material.diffuseTransmission;
    record.diffuseTransmission = diffuse.factor;
    record.diffuseTransmissionColor = diffuse.color;
    record.diffuseTransmissionSlot = slot(diffuse.texture, false);
    record.diffuseTransmissionColorSlot = slot(diffuse.colorTexture, true);
    const Volume& volume = material.volume;
    record.thickness = volume.thickness;
    record.thicknessSlot = slot(volume.thicknessTexture, false);
    record.attenuationColor = volume.attenuationColor;
    record.attenuationDistance = volume.attenuationDistance;
    record.multiscatterColor = volume.multiscatterColor;
    record.scatterAnisotropy = volume.scatterAnisotropy;
  }

  uint32_t slot(const TextureRef& use, bool srgb) {
    if (!use.present()) return gpu::kInvalidIndex;
    uvSets_ |= 1u << use.uvSet;
    packed_.textureSlots.push_back(
        {texture(static_cast<uint32_t>(use.texture), srgb), use.uvSet, use.scale, use.uRow, use.vRow});
    return static_cast<uint32_t>(packed_.textureSlots.size() - 1);
  }

  // The same image may be read both as color and as data: then it is two entries.
  uint32_t texture(uint32_t index, bool srgb) {
    const Texture& source = scene_.textures[index];
    const auto key = std::make_tuple(source.image, source.wrapS, source.wrapT, source.filter, srgb);
    const auto [entry, isNew] = textures_.try_emplace(key, static_cast<uint32_t>(packed_.textures.size()));
    if (isNew) packed_.textures.push_back({source.image, source.wrapS, source.wrapT, source.filter, srgb});
    return entry->second;
  }

  const Scene& scene_;
  PackedScene& packed_;
  uint32_t uvSets_ = 0;
  std::map<std::tuple<uint32_t, Wrap, Wrap, Filter, bool>, uint32_t> textures_;
};

} // namespace

bool isEmitter(const Material& material) { return material.emissive != glm::vec3(0) && !material.unlit; }

PackedMaterials packMaterials(const Scene& scene, const std::vector<bool>& meshUsed, PackedScene& packed) {
  PackedMaterials result;
  result.record.assign(scene.materials.size(), gpu::kInvalidIndex);
  result.uvSets.assign(scene.materials.size(), 0);
  MaterialPacker packer(scene, packed);
  for (size_t mesh = 0; mesh < scene.meshes.size(); ++mesh) {
    if (!meshUsed[mesh]) continue;
    for (const Primitive& primitive : scene.meshes[mesh].primitives) {
      if (result.record[primitive.material] != gpu::kInvalidIndex) continue;
      result.record[primitive.material] = static_cast<uint32_t>(packed.materials.size());
      result.uvSets[primitive.material] = packer.add(scene.materials[primitive.material]);
    }
  }
  return result;
}

} // namespace isophote
