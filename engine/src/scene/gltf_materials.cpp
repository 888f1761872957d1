// Source: Khronos glTF 2.0.1 specification, section 3.9 "Materials", and the README of each extension.
#include "scene/gltf_materials.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <string>

#include <fmt/format.h>

namespace isophote::gltf {
namespace {

/// Radiance above this is cut, so that its square is still finite in 32-bit floats.
constexpr float kMaxRadiance = 1e18f;

class MaterialReader {
public:
  MaterialReader(Document& document, const Json& json, std::string pointer)
      : document_(document), json_(json), pointer_(std::move(pointer)) {}

  Material read() {
    material_.name = stringOr(json_, "name", "");
    if (const Json* pbr = member(json_, "pbrMetallicRoughness")) readMetallicRoughness(*pbr);
    readAlpha();
    material_.doubleSided = boolOr(json_, "doubleSided", false);
    readEmission();
    material_.normalTexture = texture(json_, "normalTexture");
    readSurfaceExtensions();
    if (extension(json_, "KHR_materials_unlit")) keepBaseColorOnly();
    return material_;
  }

private:
  void readMetallicRoughness(const Json& pbr) {
    constexpr const char* kFactor = "baseColorFactor";
    if (const Json* color = member(pbr, kFactor)) {
      for (int i = 0; i < 4; ++i) material_.baseColor[i] = clamped((*color)[static_cast<size_t>(i)], kFactor, 0, 1);
    }
    material_.metallic = factor(pbr, "metallicFactor", 1, 0, 1);
    material_.roughness = factor(pbr, "roughnessFactor", 1, 0, 1);
    material_.baseColorTexture = texture(pbr, "baseColorTexture");
    material_.metallicRoughnessTexture = texture(pbr, "metallicRoughnessTexture");
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
    material_.alphaCutoff = factor(json_, "alphaCutoff", 0.5f, 0, FLT_MAX);
  }

  void readEmission() {
    material_.emissive = color(json_, "emissiveFactor", glm::vec3(0), 1);
    material_.emissiveTexture = texture(json_, "emissiveTexture");
    const Json* strength = extension(json_, "KHR_materials_emissive_strength");
    if (!strength) return;
    const float scale = factor(*strength, "emissiveStrength", 1, 0, kMaxRadiance);
    material_.emissive *= scale;
  }

  void readSurfaceExtensions() {
    if (const Json* ior = extension(json_, "KHR_materials_ior")) {
      // 0 stands for an infinite index; ((ior - 1) / (ior + 1))^2 is 1 for both.
      const float value = static_cast<float>(numberOr(*ior, "ior", 1.5));
      material_.ior = value == 0 ? 0 : factor(*ior, "ior", 1.5f, 1, FLT_MAX);
    }
    if (const Json* specular = extension(json_, "KHR_materials_specular")) {
      material_.specular = factor(*specular, "specularFactor", 1, 0, 1);
      material_.specularColor = color(*specular, "specularColorFactor", glm::vec3(1), FLT_MAX);
      material_.specularTexture = texture(*specular, "specularTexture");
      material_.specularColorTexture = texture(*specular, "specularColorTexture");
    }
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

  float clamped(const Json& value, const char* name, float lower, float upper) {
    const float number = value.get<float>();
    if (number < lower || number > upper) {
      const std::string range =
          upper == FLT_MAX ? fmt::format("at least {}", lower) : fmt::format("in [{}, {}]", lower, upper);
      document_.warnings.add(fmt::format("{} is clamped, it has to be {}", name, range), pointer_);
    }
    return std::clamp(number, lower, upper);
  }

  float factor(const Json& object, const char* name, float fallback, float lower, float upper) {
    const Json* value = member(object, name);
    return value ? clamped(*value, name, lower, upper) : fallback;
  }

  glm::vec3 color(const Json& object, const char* name, glm::vec3 fallback, float upper) {
    const Json* value = member(object, name);
    if (!value) return fallback;
    return {clamped((*value)[0], name, 0, upper), clamped((*value)[1], name, 0, upper),
            clamped((*value)[2], name, 0, upper)};
  }

  TextureRef texture(const Json& object, const char* name) {
    TextureRef result;
    const Json* info = member(object, name);
    if (!info) return result;
    result.texture = static_cast<int32_t>(*indexOf(*info, "index"));
    result.scale = static_cast<float>(numberOr(*info, "scale", 1));
    uint64_t uvSet = integerOr(*info, "texCoord", 0);
    if (const Json* transform = extension(*info, "KHR_texture_transform")) {
      uvSet = integerOr(*transform, "texCoord", uvSet);
      setTransform(*transform, result);
    }
    if (uvSet >= kMaxUvSets) {
      document_.warnings.add(fmt::format("a texture on a UV set above {} is left out", kMaxUvSets - 1), pointer_);
      return {};
    }
    result.uvSet = static_cast<uint32_t>(uvSet);
    return result;
  }

  /// translation * rotation * scale; v points down, so a counter-clockwise rotation of uv reads (cos, sin; -sin, cos).
  /// This is the sense in which the extension's own example picks the lower left quarter of the image.
  static void setTransform(const Json& transform, TextureRef& result) {
    const auto pair = [&](const char* name, double fallback) {
      const Json* value = member(transform, name);
      return value ? glm::dvec2((*value)[0].get<double>(), (*value)[1].get<double>()) : glm::dvec2(fallback);
    };
    const glm::dvec2 offset = pair("offset", 0);
    const glm::dvec2 scale = pair("scale", 1);
    const double angle = numberOr(transform, "rotation", 0);
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    result.uRow = glm::vec3(glm::dvec3(c * scale.x, s * scale.y, offset.x));
    result.vRow = glm::vec3(glm::dvec3(-s * scale.x, c * scale.y, offset.y));
  }

  Document& document_;
  const Json& json_;
  std::string pointer_;
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
  for (TextureRef* ref : textureRefs(result)) {
    if (ref->present()) ref->texture = textures_.use(static_cast<uint32_t>(ref->texture), scene);
  }
  scene.materials.push_back(std::move(result));
  return found->second;
}

std::vector<TextureRef*> textureRefs(Material& material) {
  return {&material.baseColorTexture, &material.metallicRoughnessTexture, &material.normalTexture,
          &material.emissiveTexture,  &material.specularTexture,          &material.specularColorTexture};
}

} // namespace isophote::gltf
