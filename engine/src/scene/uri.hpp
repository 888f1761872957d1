// The URIs of an asset to bytes: data URIs, and files that stay inside the asset's folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "scene/file_bytes.hpp"
#include "scene/gltf_document.hpp"

namespace isophote::gltf {

/// Resolves %XX; a malformed escape stays as it is.
[[nodiscard]] std::string percentDecode(std::string_view text);

/// Decodes RFC 4648 base64, padded or not; nothing where a character or the length is wrong.
[[nodiscard]] std::optional<Bytes> decodeBase64(std::string_view text);

struct LoadedUri {
  Bytes bytes;
  std::string mediaType; ///< of a data URI; empty for files
};

/// Reads what `uri`, which stands at `pointer`, refers to.
///
/// Relative references are resolved against the asset's folder only, never the current directory, and are plain names:
/// nothing is expanded. Unless LoadOptions::allowExternal, `..`, absolute paths, `file:` and symbolic links that leave
/// the folder are refused; other schemes always are.
/// @param wantedBytes  for files: read only so many of the first bytes
/// @throws SceneError, LimitError above maxBytes
[[nodiscard]] LoadedUri loadUri(const Document& document, const std::string& uri, const std::string& pointer,
                                uint64_t maxBytes, std::optional<uint64_t> wantedBytes = std::nullopt);

} // namespace isophote::gltf
