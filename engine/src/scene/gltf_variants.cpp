// Source: KHR_materials_variants.
#include "scene/gltf_variants.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "isophote/error.hpp"

namespace isophote::gltf {
namespace {

constexpr const char* kExtension = "KHR_materials_variants";

}

Variants::Variants(const Document& document) {
  if (const Json* root = extension(document.root, kExtension)) {
    for (const Json& variant : root->at("variants")) names_.push_back(variant.at("name").get<std::string>());
  }
  if (!document.options.variant) return;
  const auto found = std::find(names_.begin(), names_.end(), *document.options.variant);
  if (found == names_.end()) {
    const std::string present =
        names_.empty() ? "the asset has none" : fmt::format("there are: {}", fmt::join(names_, ", "));
    throw UsageError(fmt::format("{}: no variant '{}'; {}", document.file, *document.options.variant, present));
  }
  chosen_ = static_cast<uint32_t>(found - names_.begin());
}

std::optional<uint32_t> Variants::material(const Json& primitive) const {
  const Json* variants = chosen_ ? extension(primitive, kExtension) : nullptr;
  if (variants) {
    for (const Json& mapping : variants->at("mappings")) {
      const Json& indices = mapping.at("variants");
      const auto isChosen = [&](const Json& index) { return index.get<uint32_t>() == *chosen_; };
      if (std::any_of(indices.begin(), indices.end(), isChosen)) return indexOf(mapping, "material");
    }
  }
  return indexOf(primitive, "material");
}

} // namespace isophote::gltf
