// Source: Khronos glTF 2.0.1 specification, section 3.9 "Materials", and the README of each extension.
#include "scene/gltf_materials.hpp"

#include <cfloat>
#include <string>

#include <fmt/format.h>

#include "scene/gltf_material_extensions.hpp"
#include "scene/gltf_material_properties.hpp"
#include "scene/gltf_specular_glossiness.hpp"

namespace isophote::gltf {
namespace {

/// Radiance above this is cut, so that its square is still finite in 32-bit floats.
constexpr float kMaxRadiance = 1e18f;

class MaterialReader {
public:
  MaterialReader(Document& document, const Json& json, std::string pointer)
      : document_(document), json_(json), pointer_(std::move(pointer)), properties_(document, pointer_) {}

  Material read() {
    material_.name = stringOr(json_, "name", "");
    if (const Json* pbr = member(json_, "pbrMetallicRoughness")) readMetallicRoughness(*pbr);
    readAlpha();
    material_.doubleSided = boolOr(json_, "doubleSided", false);
    readEmission();
    material_.normalTexture = properties_.texture(json_, "normalTexture");
    readMaterialExtensions(properties_, json_, material_);
    if (extension(json_, "KHR_materials_unlit")) keepBaseColorOnly();
    return material_;
  }

private:
  void readMetallicRoughness(const Json& pbr) {
    constexpr const char* kFactor = "baseColorFactor";
    if (const Json* color = member(pbr, kFactor)) {
      for (int i = 0; i < 4; ++i) {
        material_.baseColor[i] = properties_.clamped((*color)[static_cast<size_t>(i)], kFactor, 0, 1);
      }
    }
    material_.metallic = properties_.factor(pbr, "metallicFactor", 1, 0, 1);
    material_.roughness = properties_.factor(pbr, "roughnessFactor", 1, 0, 1);
    material_.baseColorTexture = properties_.texture(pbr, "baseColorTexture");
    material_.metallicRoughnessTexture = properties_.texture(pbr, "metallicRoughnessTexture");
  }

  void readAlpha() {
    const std::string mode = stringOr(json_, "alphaMode", "OPAQUE");
    if (mode == "MASK") {
      material_.alphaMode = AlphaMode::Mask;
    } else if (mode == "BLEND") {
      material_.alphaMode = AlphaMode::Blend;
    } else if (mode != "OPAQUE") {
      document_.fail(pointer_ + "/alphaMode", "OPAQUE, MASK or BLEND");
    }
    material_.alphaCutoff = properties_.factor(json_, "alphaCutoff", 0.5f, 0, FLT_MAX);
  }

  void readEmission() {
    material_.emissive = properties_.color(json_, "emissiveFactor", glm::vec3(0), 1);
    material_.emissiveTexture = properties_.texture(json_, "emissiveTexture");
    const Json* strength = extension(json_, "KHR_materials_emissive_strength");
    if (!strength) return;
    const float scale = properties_.factor(*strength, "emissiveStrength", 1, 0, kMaxRadiance);
    material_.emissive *= scale;
  }

  /// KHR_materials_unlit: nothing else of the material has a meaning.
  void keepBaseColorOnly() {
    Material unlit;
    unlit.name = material_.name;
    unlit.baseColor = material_.baseColor;
    unlit.baseColorTexture = material_.baseColorTexture;
    unlit.alphaMode = material_.alphaMode;
    unlit.alphaCutoff = material_.alphaCutoff;
    unlit.doubleSided = material_.doubleSided;
    unlit.unlit = true;
    material_ = unlit;
  }

  Document& document_;
  const Json& json_;
  std::string pointer_;
  MaterialProperties properties_;
  Material material_;
};

} // namespace

std::vector<Material> readMaterials(Document& document) {
  const Json& materials = arrayOrEmpty(document.root, "materials");
  std::vector<Material> result;
  result.reserve(materials.size());
  for (size_t i = 0; i < materials.size(); ++i) {
    result.push_back(MaterialReader(document, materials[i], fmt::format("/materials/{}", i)).read());
  }
  return result;
}

uint32_t MaterialTable::use(std::optional<uint32_t> material, Scene& scene) { return add(material, true, scene); }

uint32_t MaterialTable::useWithoutNormalTexture(std::optional<uint32_t> material, Scene& scene) {
  return add(material, false, scene);
}

uint32_t MaterialTable::add(std::optional<uint32_t> material, bool withNormalTexture, Scene& scene) {
  const auto [found, isNew] = used_.try_emplace({material, withNormalTexture}, 0);
  if (!isNew) return found->second;
  found->second = static_cast<uint32_t>(scene.materials.size());
  Material result = material ? materials_[*material] : Material{};
  if (!withNormalTexture) result.normalTexture = {};
  const std::optional<float> glossiness =
      material ? texturedGlossiness(arrayOrEmpty(document_.root, "materials")[*material]) : std::nullopt;
  for (TextureRef* ref : textureRefs(result)) {
    if (!ref->present()) continue;
    const auto index = static_cast<uint32_t>(ref->texture);
    const bool holdsGlossiness = glossiness && ref == &result.metallicRoughnessTexture;
    ref->texture = holdsGlossiness ? textures_.useGlossiness(index, *glossiness, scene) : textures_.use(index, scene);
  }
  scene.materials.push_back(std::move(result));
  return found->second;
}

} // namespace isophote::gltf
