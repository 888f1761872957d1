#include "scene/gltf_extensions.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <string_view>

#include <fmt/format.h>

#include "isophote/error.hpp"

namespace isophote::gltf {
namespace {

constexpr std::array<std::string_view, 10> kModeled{
    "EXT_mesh_gpu_instancing", "KHR_lights_punctual",    "KHR_materials_emissive_strength",
    "KHR_materials_ior",       "KHR_materials_specular", "KHR_materials_transmission",
    "KHR_materials_unlit",     "KHR_mesh_quantization",  "KHR_node_visibility",
    "KHR_texture_transform"};

/// Extensions that carry a plain glTF fallback beside their own data; the fallback is used.
constexpr std::array<std::string_view, 5> kFallback{"EXT_meshopt_compression", "EXT_texture_webp",
                                                    "KHR_draco_mesh_compression", "KHR_meshopt_compression",
                                                    "KHR_texture_basisu"};

bool isModeled(const std::string& name) { return std::find(kModeled.begin(), kModeled.end(), name) != kModeled.end(); }

bool hasFallback(const std::string& name) {
  return std::find(kFallback.begin(), kFallback.end(), name) != kFallback.end();
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
    document.warnings.add(hasFallback(name) ? fmt::format("extension {} is ignored, its fallback is used", name)
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
