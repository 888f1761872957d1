// Source: KHR_materials_pbrSpecularGlossiness, "Extending Materials"; the reading as a dielectric of infinite index is
// that of KHR_materials_specular, "Materials with reflectance parameter".
#include "scene/gltf_specular_glossiness.hpp"

#include <cfloat>
#include <cmath>
#include <cstring>

namespace isophote::gltf {
namespace {

constexpr const char* kExtension = "KHR_materials_pbrSpecularGlossiness";

}

void readSpecularGlossiness(MaterialProperties& properties, const Json& json, Material& material) {
  constexpr const char* kDiffuse = "diffuseFactor";
  material.baseColor = glm::vec4(1);
  if (const Json* diffuse = member(json, kDiffuse)) {
    for (int i = 0; i < 4; ++i) {
      material.baseColor[i] = properties.clamped((*diffuse)[static_cast<size_t>(i)], kDiffuse, 0, 1);
    }
  }
  material.baseColorTexture = properties.texture(json, "diffuseTexture");
  material.metallic = 0;
  material.ior = 0; // stands for an infinite one
  material.specular = 1;
  material.specularTexture = {};
  material.specularColor = properties.color(json, "specularFactor", glm::vec3(1), 1);
  material.specularColorTexture = properties.texture(json, "specularGlossinessTexture");
  material.metallicRoughnessTexture = material.specularColorTexture;
  const float glossiness = properties.factor(json, "glossinessFactor", 1, 0, 1);
  material.roughness = material.metallicRoughnessTexture.present() ? 1 : 1 - glossiness;
}

std::optional<float> texturedGlossiness(const Json& material) {
  const Json* json = extension(material, kExtension);
  if (!json || !json->contains("specularGlossinessTexture")) return std::nullopt;
  return static_cast<float>(glm::clamp(numberOr(*json, "glossinessFactor", 1), 0.0, 1.0));
}

ImageData roughnessFromGlossiness(const ImageData& image, float glossinessFactor) {
  ImageData result{.name = image.name + " (roughness)", .width = image.width, .height = image.height};
  const size_t pixelCount = size_t{image.width} * image.height;
  const size_t channelBytes = image.bitsPerChannel / 8;
  constexpr size_t kAlpha = 3;
  constexpr float kWhite = 255;
  result.pixels.resize(pixelCount * 4);
  for (size_t i = 0; i < pixelCount; ++i) {
    // The higher byte of 16 bits stands second.
    const std::byte alpha = image.pixels[(i * 4 + kAlpha) * channelBytes + channelBytes - 1];
    const float glossiness = glossinessFactor * static_cast<float>(std::to_integer<int>(alpha)) / kWhite;
    result.pixels[i * 4 + 1] = static_cast<std::byte>(std::lround((1 - glossiness) * kWhite));
    result.pixels[i * 4 + kAlpha] = std::byte{0xff};
  }
  return result;
}

} // namespace isophote::gltf
