// KHR_materials_pbrSpecularGlossiness (archived by Khronos, still common): read as metallic-roughness with
// KHR_materials_ior and KHR_materials_specular.
#pragma once

#include <optional>

#include "isophote/scene.hpp"
#include "scene/gltf_material_properties.hpp"

namespace isophote::gltf {

/// A dielectric of infinite index, whose reflectance at normal incidence is then the specular color, over the diffuse
/// color; roughness is 1 - glossiness. metallicRoughnessTexture is the glossiness texture, whose alpha
/// Textures::useGlossiness turns into roughness.
void readSpecularGlossiness(MaterialProperties& properties, const Json& json, Material& material);

/// The factor on the glossiness in a texture's alpha, for a material that has one.
[[nodiscard]] std::optional<float> texturedGlossiness(const Json& material);

/// Roughness as glTF stores it, in green; metallic, in blue, is 0. 8 bits.
/// @param image  as decoded, glossiness in alpha
[[nodiscard]] ImageData roughnessFromGlossiness(const ImageData& image, float glossinessFactor);

} // namespace isophote::gltf
