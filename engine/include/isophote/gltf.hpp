// glTF 2.0 in.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "isophote/scene.hpp"

namespace isophote {

struct LoadOptions {
  std::optional<uint32_t> scene;        ///< index; absent: the asset's default, else 0
  std::optional<std::string> variant;   ///< name of a KHR_materials_variants variant; absent: the default materials
  bool allowExternal = false;           ///< let URIs leave the asset's folder
  uint64_t maxImagePixels = 1ull << 28; ///< per image, checked before decoding
  uint64_t maxBufferBytes = 8ull << 30; ///< all buffers together
  uint32_t maxNodes = 4'000'000;
};

/// Reads a .gltf or .glb file and validates every index, byte range and number in it.
/// @throws SceneError (broken), UnsupportedError (unknown required extension), LimitError (too large), UsageError (no
/// such variant)
[[nodiscard]] Scene loadGltf(const std::filesystem::path& file, const LoadOptions& options = {});

/// The names that LoadOptions::variant chooses from, in the asset's order.
/// @throws SceneError, UnsupportedError, LimitError
[[nodiscard]] std::vector<std::string> gltfVariants(const std::filesystem::path& file);

/// Reads an equirectangular Radiance .hdr or OpenEXR map into an Environment.
/// NaN and negative pixels are set to 0, infinite ones to the largest finite value, each counted in a warning.
/// @throws SceneError, LimitError
[[nodiscard]] Environment loadEnvironment(const std::filesystem::path& file, std::vector<std::string>& warnings);

} // namespace isophote
