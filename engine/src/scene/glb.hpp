// The GLB container: a header and chunks.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "scene/warning_log.hpp"

namespace isophote::gltf {

struct GlbChunks {
  std::span<const std::byte> json;
  std::span<const std::byte> binary; ///< empty where there is none
};

/// True where `bytes` begin with the magic number "glTF".
[[nodiscard]] bool isGlb(std::span<const std::byte> bytes);

/// Finds the chunks of a GLB 2 file; both spans point into `bytes`.
/// @throws SceneError where the header or a chunk does not fit the file
[[nodiscard]] GlbChunks splitGlb(const std::string& file, std::span<const std::byte> bytes, WarningLog& warnings);

} // namespace isophote::gltf
