// KHR_materials_variants: other materials for the same meshes, chosen by name.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scene/gltf_document.hpp"

namespace isophote::gltf {

class Variants {
public:
  /// Takes the variant that the document's options name.
  /// @throws UsageError listing the variants there are where none has that name
  explicit Variants(const Document& document);

  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }

  /// The material of a primitive in the chosen variant: the default one where no variant is chosen or none maps it.
  [[nodiscard]] std::optional<uint32_t> material(const Json& primitive) const;

private:
  std::vector<std::string> names_;
  std::optional<uint32_t> chosen_;
};

} // namespace isophote::gltf
