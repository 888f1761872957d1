// Which glTF extensions this build models, and what happens to assets that ask for others.
#pragma once

#include <string>
#include <vector>

#include "scene/gltf_document.hpp"

namespace isophote::gltf {

/// Checks both lists and warns of every optional extension that is not modeled.
/// @throws UnsupportedError naming every required extension that is not modeled; SceneError where a list is malformed
void checkExtensions(Document& document);

/// extensionsUsed as listed in the asset.
[[nodiscard]] std::vector<std::string> extensionsUsed(const Document& document);
/// Those of extensionsUsed that have no effect on the Scene.
[[nodiscard]] std::vector<std::string> extensionsIgnored(const Document& document);

} // namespace isophote::gltf
