// An asset on its way in: checked JSON, the binary chunk, where it came from and what was found odd so far.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "isophote/gltf.hpp"
#include "scene/file_bytes.hpp"
#include "scene/gltf_json.hpp"
#include "scene/warning_log.hpp"

namespace isophote::gltf {

struct Document {
  std::string file;             ///< as given, for messages
  std::filesystem::path folder; ///< URIs are resolved against it
  LoadOptions options;
  Json root;
  Bytes fileBytes;                        ///< of a .glb; empty for a .gltf
  std::span<const std::byte> binaryChunk; ///< into fileBytes; empty where there is none
  WarningLog warnings;
  uint64_t decodedBytes = 0; ///< claimed so far

  /// @throws SceneError
  [[noreturn]] void fail(const std::string& pointer, const std::string& expected) const;

  /// Announces `bytes` of decoded geometry or pixels, before they are allocated.
  /// @throws LimitError where the sum exceeds LoadOptions::maxBufferBytes: small files can ask for any amount
  void claim(uint64_t bytes, const std::string& pointer);
};

/// Reads a .gltf or .glb (told apart by content), checks version, required extensions and the shape of the whole tree.
/// @throws SceneError, UnsupportedError, LimitError
[[nodiscard]] Document openDocument(const std::filesystem::path& file, const LoadOptions& options);

} // namespace isophote::gltf
