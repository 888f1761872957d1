#include "upload/pack_materials.hpp"

#include "scene/medium.hpp"
#include "shared/bsdf_constants.h"
#include "upload/film_albedo.hpp"
#include "upload/glass_loss.hpp"

#include <algorithm>
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
    packed_.materialNames.push_back(material.name);
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
    record.exactAlbedo = exactAlbedo(material);
    record.dispersion = material.dispersion;
    record.alphaCutoff = material.alphaCutoff;
    record.alphaMode = static_cast<uint32_t>(material.alphaMode);
    record.flags = (material.doubleSided ? gpu::kMaterialDoubleSided : 0) | (material.unlit ? gpu::kMaterialUnlit : 0) |
                   (material.conductor.given ? gpu::kMaterialConductor : 0);
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
    record.anisotropicAlbedo = anisotropicAlbedo(material);
    const Iridescence& iridescence = material.iridescence;
    record.iridescence = iridescence.factor;
    record.iridescenceIor = iridescence.ior;
    record.iridescenceThicknessMinimum = iridescence.thicknessMinimum;
    record.iridescenceThicknessMaximum = iridescence.thicknessMaximum;
    record.filmAlbedo = filmAlbedo(material);
    record.conductorN = material.conductor.n;
    record.conductorK = material.conductor.k;
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
    record.glassLoss = glassLoss(material);
    const MediumCoefficients medium = mediumCoefficients(volume);
    record.extinction = medium.extinction;
    record.scatteringAlbedo = medium.albedo;
    record.scatterAnisotropy = volume.scatterAnisotropy;
    record.mediumPriority = volume.priority;
    if (isVolume(material)) record.flags |= gpu::kMaterialVolume;
    if (isClear(material)) record.flags |= gpu::kMaterialClear;
  }

  // Where the table for the material's index begins. Thin walls refract nothing, and smooth glass loses nothing.
  uint32_t glassLoss(const Material& material) {
    const bool smooth = material.roughness * material.roughness < gpu::kMirrorAlpha;
    if (material.transmission.factor == 0 || material.volume.thickness == 0 || material.ior < 1 || smooth)
      return gpu::kInvalidIndex;
    const bool textured = material.metallicRoughnessTexture.present();
    std::vector<GlassSurface>& glass = packed_.tables.glass;
    const auto [entry, isNew] =
        glassLosses_.try_emplace(std::make_tuple(material.ior, material.dispersion, material.roughness, textured),
                                 static_cast<uint32_t>(glass.size()) * 2 * gpu::kGlassLossHalf);
    if (isNew) {
      const glm::vec3 iors = channelIors(material);
      for (int channel = 0; channel < (isDispersive(material) ? 3 : 1); ++channel) {
        glass.push_back({iors[channel], {textured ? 0 : material.roughness, material.roughness}});
      }
    }
    return entry->second;
  }

  // Where the table of its anisotropic facets begins.
  uint32_t anisotropicAlbedo(const Material& material) {
    if (material.anisotropy.strength <= 0) return gpu::kInvalidIndex;
    const auto range = [](float largest, bool textured) { return glm::vec2(textured ? 0 : largest, largest); };
    const AnisotropicSurface surface{range(material.roughness, material.metallicRoughnessTexture.present()),
                                     range(material.anisotropy.strength, material.anisotropy.texture.present())};
    uint32_t first = 0;
    for (const AnisotropicSurface& known : packed_.tables.anisotropic) {
      if (known == surface) return first;
      first += anisotropicAlbedoSize(known);
    }
    packed_.tables.anisotropic.push_back(surface);
    return first;
  }

  // Where the table of its dielectric under a film begins. It is of one color of facets without a direction.
  uint32_t filmAlbedo(const Material& material) {
    const Iridescence& film = material.iridescence;
    const bool metal = material.metallic == 1 && !material.metallicRoughnessTexture.present();
    const bool colorVaries = material.specularTexture.present() || material.specularColorTexture.present() ||
                             (isDispersive(material) && material.transmission.factor > 0);
    if (film.factor == 0 || metal || colorVaries || material.anisotropy.strength > 0) return gpu::kInvalidIndex;
    const float amplitude = (material.ior - 1) / (material.ior + 1);
    const float roughness = material.roughness;
    const auto [thinnest, thickest] = std::minmax(film.thicknessMinimum, film.thicknessMaximum);
    const FilmSurface surface{
        .f0 = glm::min(amplitude * amplitude * material.specularColor, glm::vec3(1)) * material.specular,
        .ior = film.ior,
        .thickness = film.thicknessTexture.present() ? glm::vec2(thinnest, thickest) : glm::vec2(film.thicknessMaximum),
        .roughness = {material.metallicRoughnessTexture.present() ? 0 : roughness, roughness}};
    uint32_t first = 0;
    for (const FilmSurface& known : packed_.tables.films) {
      if (known == surface) return first;
      first += filmAlbedoSize(known);
    }
    packed_.tables.films.push_back(surface);
    return first;
  }

  // Where the table of exact reflectance for the material's index begins, behind the one that all share.
  uint32_t exactAlbedo(const Material& material) {
    std::vector<float>& iors = packed_.tables.opaqueIors;
    auto found = std::find(iors.begin(), iors.end(), material.ior);
    if (found == iors.end()) found = iors.insert(found, material.ior);
    return static_cast<uint32_t>(found - iors.begin() + 1) * gpu::kFacetAlbedoSize;
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
  std::map<std::tuple<float, float, float, bool>, uint32_t>
      glassLosses_; ///< by index, dispersion, roughness and whether that is textured
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
      uint32_t& record = result.record[primitive.material];
      if (record == gpu::kInvalidIndex) {
        record = static_cast<uint32_t>(packed.materials.size());
        result.uvSets[primitive.material] = packer.add(scene.materials[primitive.material]);
      }
      if (!primitive.colors.empty()) packed.materials[record].flags &= ~gpu::kMaterialClear; // they tint it
    }
  }
  return result;
}

} // namespace isophote
