#include "isophote/features.hpp"

#include "scene/medium.hpp"
#include "shared/bsdf_constants.h"

#include <algorithm>
#include <cmath>

namespace isophote {
namespace {

/// Smallest value of the green channel, in [0, 1]. Filtering cannot go below it.
float smallestGreen(const ImageData& image) {
  const size_t channelBytes = image.bitsPerChannel / 8;
  uint32_t smallest = 0xffff;
  for (size_t at = channelBytes; at + channelBytes <= image.pixels.size(); at += 4 * channelBytes) {
    uint32_t value = std::to_integer<uint32_t>(image.pixels[at]);
    if (channelBytes == 2) value |= std::to_integer<uint32_t>(image.pixels[at + 1]) << 8;
    smallest = std::min(smallest, value);
  }
  return static_cast<float>(smallest) / (channelBytes == 2 ? 65535.0f : 255.0f);
}

/// Widens the limit by far more than the rounding of texture filtering (8 bits of interpolation weight are the least
/// that Vulkan allows), so that the feature is never missing on the device.
constexpr float kFilteringMargin = 1.01f;

/// Up to this many lights are chosen by power alone (docs/many-lights.md, which also says where more should be).
constexpr uint64_t kFewLights = 16;

bool canBeMirror(const Scene& scene, const Material& material) {
  const float limit = std::sqrt(gpu::kMirrorAlpha) * kFilteringMargin;
  if (material.roughness < limit) return true;
  if (!material.metallicRoughnessTexture.present()) return false;
  const Texture& texture = scene.textures[static_cast<size_t>(material.metallicRoughnessTexture.texture)];
  return material.roughness * smallestGreen(scene.images[texture.image]) < limit;
}

void addMaterial(const Scene& scene, const Material& material, FeatureSet& features) {
  const std::vector<const TextureRef*> refs = textureRefs(material);
  if (std::any_of(refs.begin(), refs.end(), [](const TextureRef* ref) { return ref->present(); })) {
    features.add(Feature::kHasTextures);
  }
  if (material.normalTexture.present() || material.clearcoat.normalTexture.present()) {
    features.add(Feature::kHasNormalMaps);
  }
  if (material.alphaMode != AlphaMode::Opaque) features.add(Feature::kHasAlpha);
  if (material.emissive != glm::vec3(0)) features.add(Feature::kHasEmissiveTriangles);
  if (material.unlit) {
    features.add(Feature::kHasUnlit);
    return;
  }
  if (isVolume(material)) {
    features.add(Feature::kHasVolumes);
    const MediumCoefficients medium = mediumCoefficients(material.volume);
    if (medium.extinction * medium.albedo != glm::vec3(0)) features.add(Feature::kHasScatteringMedia);
  }
  if (material.diffuseTransmission.factor > 0 && (material.metallic < 1 || material.metallicRoughnessTexture.present()))
    features.add(Feature::kHasDiffuseTransmission);
  if (material.clearcoat.factor > 0) features.add(Feature::kHasClearcoat);
  if (material.sheen.color != glm::vec3(0)) features.add(Feature::kHasSheen);
  // Factors multiply textures of at most 1, so a factor of 0 rules the lobe out. A dielectric with ior 1 keeps its
  // grazing reflection (f90 = specular).
  const bool transmits = material.transmission.factor > 0 && material.ior >= 1 &&
                         (material.metallic < 1 || material.metallicRoughnessTexture.present());
  if (transmits) features.add(Feature::kHasTransmission);
  if (transmits && isDispersive(material)) features.add(Feature::kHasDispersion);
  const bool hasFilm = material.iridescence.factor > 0;
  if (material.metallic == 0 && material.specular == 0 && !transmits && !hasFilm) return;
  features.add(Feature::kHasSpecular);
  if (material.anisotropy.strength > 0) features.add(Feature::kHasAnisotropy);
  if (hasFilm) features.add(Feature::kHasIridescence);
  if (material.conductor.given && material.metallic > 0) features.add(Feature::kHasConductor);
  if (canBeMirror(scene, material)) features.add(Feature::kHasMirror);
}

/// Lights with a place: emissive triangles of all instances, point and spot lights.
uint64_t placedLights(const Scene& scene) {
  std::vector<uint64_t> ofMesh;
  for (const Mesh& mesh : scene.meshes) {
    uint64_t triangles = 0;
    for (const Primitive& primitive : mesh.primitives) {
      const Material& material = scene.materials[primitive.material];
      if (material.emissive != glm::vec3(0) && !material.unlit) triangles += primitive.indices.size() / 3;
    }
    ofMesh.push_back(triangles);
  }
  uint64_t count = 0;
  for (const Instance& instance : scene.instances) count += ofMesh[instance.mesh];
  for (const PunctualLight& light : scene.lights) count += light.kind == LightKind::Directional ? 0 : 1;
  return count;
}

} // namespace

const std::vector<FeatureDescription>& allFeatures() {
  static const std::vector<FeatureDescription> features{
#define ISOPHOTE_FEATURE(id, constant, name, omitted) {Feature::constant, name, omitted},
#include "shared/features.inc"
#undef ISOPHOTE_FEATURE
  };
  return features;
}

FeatureSet FeatureSet::all() {
  FeatureSet set;
  for (const auto& description : allFeatures()) set.add(description.feature);
  return set;
}

std::vector<std::string> FeatureSet::names() const {
  std::vector<std::string> names;
  for (const auto& description : allFeatures()) {
    if (has(description.feature)) names.emplace_back(description.name);
  }
  return names;
}

FeatureSet sceneFeatures(const Scene& scene) {
  FeatureSet features;
  std::vector<bool> meshUsed(scene.meshes.size(), false);
  for (const auto& instance : scene.instances) meshUsed[instance.mesh] = true;
  std::vector<bool> materialUsed(scene.materials.size(), false);
  for (size_t i = 0; i < scene.meshes.size(); ++i) {
    if (!meshUsed[i]) continue;
    for (const auto& primitive : scene.meshes[i].primitives) {
      materialUsed[primitive.material] = true;
      if (!primitive.normals.empty()) features.add(Feature::kHasShadingNormals);
      if (!primitive.colors.empty()) features.add(Feature::kHasVertexColors);
    }
  }
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    if (materialUsed[i]) addMaterial(scene, scene.materials[i], features);
  }
  for (const PunctualLight& light : scene.lights) {
    features.add(light.isSphere() ? Feature::kHasSphereLights
                 : light.isSun()  ? Feature::kHasSuns
                                  : Feature::kHasPunctualLights);
  }
  if (placedLights(scene) > kFewLights) features.add(Feature::kHasLightTree);
  if (scene.environment) features.add(Feature::kHasEnvironment);
  return features;
}

} // namespace isophote
