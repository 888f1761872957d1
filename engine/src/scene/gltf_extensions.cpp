#include "scene/gltf_extensions.hpp"

#include <algorithm>
#include <set>
#include <span>
#include <string_view>

#include <fmt/format.h>

#include "isophote/error.hpp"
#include "scene/draco_decode.hpp"
#include "scene/meshopt_decode.hpp"
#include "scene/webp_decode.hpp"

namespace isophote::gltf {
namespace {

constexpr std::string_view kModeled[] = {
    "EXT_lights_image_based",
    "EXT_mesh_gpu_instancing",
    "KHR_lights_punctual",
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_diffuse_transmission",
    "KHR_materials_dispersion",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_materials_volume",
    "KHR_materials_volume_scatter",
    "KHR_mesh_quantization",
    "KHR_node_visibility",
    "KHR_texture_transform",
};

/// Extensions that say nothing about an image.
constexpr std::string_view kWithoutEffect[] = {
    "KHR_animation_pointer", // targets of animations; the scene is in its static pose
    "KHR_xmp_json_ld",       // metadata
};

/// Extensions that carry a plain glTF fallback beside their own data; without a decoder the fallback is used.
struct Compression {
  std::string_view name;
  bool (*available)();
};
bool never() { return false; }
constexpr Compression kCompressions[] = {
    {"EXT_meshopt_compression", meshoptAvailable},
    {"EXT_texture_webp", webpAvailable},
    {"KHR_draco_mesh_compression", dracoAvailable},
    {"KHR_meshopt_compression", meshoptAvailable},
    {"KHR_texture_basisu", never},
};

const Compression* findCompression(const std::string& name) {
  const auto* found = std::find_if(std::begin(kCompressions), std::end(kCompressions),
                                   [&](const Compression& compression) { return compression.name == name; });
  return found == std::end(kCompressions) ? nullptr : found;
}

bool isIn(std::span<const std::string_view> list, const std::string& name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

bool isModeled(const std::string& name) {
  const Compression* compression = findCompression(name);
  return compression ? compression->available() : isIn(kModeled, name) || isIn(kWithoutEffect, name);
}

std::vector<std::string> names(const Document& document, const char* list) {
  const Json* found = member(document.root, list);
  if (!found) return {};
  if (!found->is_array()) document.fail(fmt::format("/{}", list), "an array of extension names");
  std::vector<std::string> result;
  for (size_t i = 0; i < found->size(); ++i) {
    const Json& name = (*found)[i];
    if (!name.is_string()) document.fail(fmt::format("/{}/{}", list, i), "an extension name");
    result.push_back(name.get<std::string>());
  }
  return result;
}

} // namespace

void checkExtensions(Document& document) {
  std::vector<std::string> missing;
  for (const std::string& name : names(document, "extensionsRequired")) {
    if (!isModeled(name)) missing.push_back(name);
  }
  if (!missing.empty()) {
    throw UnsupportedError(document.file, "/extensionsRequired",
                           fmt::format("extensions that this build offers, not {}", fmt::join(missing, ", ")));
  }
  for (const std::string& name : extensionsIgnored(document)) {
    document.warnings.add(findCompression(name) ? fmt::format("extension {} is ignored, its fallback is used", name)
                                                : fmt::format("extension {} is ignored", name));
  }
}

std::vector<std::string> extensionsUsed(const Document& document) { return names(document, "extensionsUsed"); }

std::vector<std::string> extensionsIgnored(const Document& document) {
  std::vector<std::string> result;
  std::set<std::string> seen;
  for (const std::string& name : extensionsUsed(document)) {
    if (!isModeled(name) && seen.insert(name).second) result.push_back(name);
  }
  return result;
}

} // namespace isophote::gltf
