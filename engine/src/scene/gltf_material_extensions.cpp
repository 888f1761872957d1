// Source: the README of each extension in KhronosGroup/glTF.
#include "scene/gltf_material_extensions.hpp"

#include <cfloat>

#include "scene/gltf_specular_glossiness.hpp"

namespace isophote::gltf {
namespace {

void readIor(MaterialProperties& properties, const Json& ior, Material& material) {
  // 0 stands for an infinite index; ((ior - 1) / (ior + 1))^2 is 1 for both.
  const float value = static_cast<float>(numberOr(ior, "ior", 1.5));
  material.ior = value == 0 ? 0 : properties.factor(ior, "ior", 1.5f, 1, FLT_MAX);
}

void readSpecular(MaterialProperties& properties, const Json& specular, Material& material) {
  material.specular = properties.factor(specular, "specularFactor", 1, 0, 1);
  material.specularColor = properties.color(specular, "specularColorFactor", glm::vec3(1), FLT_MAX);
  material.specularTexture = properties.texture(specular, "specularTexture");
  material.specularColorTexture = properties.texture(specular, "specularColorTexture");
}

void readClearcoat(MaterialProperties& properties, const Json& json, Clearcoat& clearcoat) {
  clearcoat.factor = properties.factor(json, "clearcoatFactor", 0, 0, 1);
  clearcoat.roughness = properties.factor(json, "clearcoatRoughnessFactor", 0, 0, 1);
  clearcoat.texture = properties.texture(json, "clearcoatTexture");
  clearcoat.roughnessTexture = properties.texture(json, "clearcoatRoughnessTexture");
  clearcoat.normalTexture = properties.texture(json, "clearcoatNormalTexture");
}

void readSheen(MaterialProperties& properties, const Json& json, Sheen& sheen) {
  sheen.color = properties.color(json, "sheenColorFactor", glm::vec3(0), 1);
  sheen.roughness = properties.factor(json, "sheenRoughnessFactor", 0, 0, 1);
  sheen.colorTexture = properties.texture(json, "sheenColorTexture");
  sheen.roughnessTexture = properties.texture(json, "sheenRoughnessTexture");
}

void readAnisotropy(MaterialProperties& properties, const Json& json, Anisotropy& anisotropy) {
  anisotropy.strength = properties.factor(json, "anisotropyStrength", 0, 0, 1);
  anisotropy.rotation = static_cast<float>(numberOr(json, "anisotropyRotation", 0));
  anisotropy.texture = properties.texture(json, "anisotropyTexture");
}

void readIridescence(MaterialProperties& properties, const Json& json, Iridescence& iridescence) {
  iridescence.factor = properties.factor(json, "iridescenceFactor", 0, 0, 1);
  iridescence.ior = properties.factor(json, "iridescenceIor", 1.3f, 1, FLT_MAX);
  iridescence.thicknessMinimum = properties.factor(json, "iridescenceThicknessMinimum", 100, 0, FLT_MAX);
  iridescence.thicknessMaximum = properties.factor(json, "iridescenceThicknessMaximum", 400, 0, FLT_MAX);
  iridescence.texture = properties.texture(json, "iridescenceTexture");
  iridescence.thicknessTexture = properties.texture(json, "iridescenceThicknessTexture");
}

void readTransmission(MaterialProperties& properties, const Json& json, Transmission& transmission) {
  transmission.factor = properties.factor(json, "transmissionFactor", 0, 0, 1);
  transmission.texture = properties.texture(json, "transmissionTexture");
}

void readDiffuseTransmission(MaterialProperties& properties, const Json& json, DiffuseTransmission& transmission) {
  transmission.factor = properties.factor(json, "diffuseTransmissionFactor", 0, 0, 1);
  transmission.color = properties.color(json, "diffuseTransmissionColorFactor", glm::vec3(1), 1);
  transmission.texture = properties.texture(json, "diffuseTransmissionTexture");
  transmission.colorTexture = properties.texture(json, "diffuseTransmissionColorTexture");
}

void readVolume(MaterialProperties& properties, const Json& json, Volume& volume) {
  volume.thickness = properties.factor(json, "thicknessFactor", 0, 0, FLT_MAX);
  volume.thicknessTexture = properties.texture(json, "thicknessTexture");
  volume.attenuationColor = properties.color(json, "attenuationColor", glm::vec3(1), 1);
  volume.attenuationDistance = properties.factor(json, "attenuationDistance", 0, 0, FLT_MAX);
}

void readVolumeScatter(MaterialProperties& properties, const Json& json, Volume& volume) {
  constexpr float kLargestAnisotropy = 0.999f; // 1 would scatter straight ahead only
  volume.multiscatterColor = properties.color(json, "multiscatterColor", glm::vec3(0), 1);
  volume.scatterAnisotropy = properties.factor(json, "scatterAnisotropy", 0, -kLargestAnisotropy, kLargestAnisotropy);
}

} // namespace

void readMaterialExtensions(MaterialProperties& properties, const Json& json, Material& material) {
  const auto read = [&](const char* name, auto&& function, auto& target) {
    if (const Json* found = extension(json, name)) function(properties, *found, target);
  };
  read("KHR_materials_pbrSpecularGlossiness", readSpecularGlossiness, material);
  read("KHR_materials_ior", readIor, material);
  read("KHR_materials_specular", readSpecular, material);
  read("KHR_materials_clearcoat", readClearcoat, material.clearcoat);
  read("KHR_materials_sheen", readSheen, material.sheen);
  read("KHR_materials_anisotropy", readAnisotropy, material.anisotropy);
  read("KHR_materials_iridescence", readIridescence, material.iridescence);
  read("KHR_materials_transmission", readTransmission, material.transmission);
  read("KHR_materials_diffuse_transmission", readDiffuseTransmission, material.diffuseTransmission);
  read("KHR_materials_volume", readVolume, material.volume);
  read("KHR_materials_volume_scatter", readVolumeScatter, material.volume);
  if (const Json* dispersion = extension(json, "KHR_materials_dispersion")) {
    material.dispersion = properties.factor(*dispersion, "dispersion", 0, 0, FLT_MAX);
  }
}

} // namespace isophote::gltf
