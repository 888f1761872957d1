// Source: Khronos glTF 2.0.1 specification, section 4.4 "Binary glTF Layout".
#include "scene/glb.hpp"

#include <cstdint>

#include <fmt/format.h>

#include "isophote/error.hpp"

namespace isophote::gltf {
namespace {

constexpr uint32_t kMagic = 0x46546c67;       // "glTF"
constexpr uint32_t kJsonChunk = 0x4e4f534a;   // "JSON"
constexpr uint32_t kBinaryChunk = 0x004e4942; // "BIN\0"
constexpr size_t kHeaderBytes = 12;
constexpr size_t kChunkHeaderBytes = 8;

uint32_t readU32(std::span<const std::byte> bytes, size_t offset) {
  uint32_t value = 0;
  for (size_t i = 0; i < 4; ++i) value |= std::to_integer<uint32_t>(bytes[offset + i]) << (8 * i);
  return value;
}

} // namespace

bool isGlb(std::span<const std::byte> bytes) { return bytes.size() >= 4 && readU32(bytes, 0) == kMagic; }

GlbChunks splitGlb(const std::string& file, std::span<const std::byte> bytes, WarningLog& warnings) {
  if (bytes.size() < kHeaderBytes)
    throw SceneError(file, "", "a GLB header of 12 bytes (GLB_UNEXPECTED_END_OF_HEADER)");
  const uint32_t version = readU32(bytes, 4);
  if (version != 2) throw SceneError(file, "", fmt::format("GLB version 2, found {} (GLB_INVALID_VERSION)", version));
  const uint32_t length = readU32(bytes, 8);
  if (length > bytes.size() || length < kHeaderBytes) {
    throw SceneError(
        file, "",
        fmt::format("a GLB length of {} bytes, the header says {} (GLB_LENGTH_MISMATCH)", bytes.size(), length));
  }
  if (length < bytes.size()) warnings.add("bytes after the end of the GLB are ignored");

  GlbChunks chunks;
  bool hasBinary = false;
  size_t offset = kHeaderBytes;
  for (size_t index = 0; offset < length; ++index) {
    if (length - offset < kChunkHeaderBytes) {
      throw SceneError(file, "", fmt::format("a header for GLB chunk {} (GLB_UNEXPECTED_END_OF_CHUNK_HEADER)", index));
    }
    const uint32_t chunkBytes = readU32(bytes, offset);
    const uint32_t type = readU32(bytes, offset + 4);
    offset += kChunkHeaderBytes;
    if (chunkBytes > length - offset) {
      throw SceneError(file, "",
                       fmt::format("GLB chunk {} inside the file, {} bytes are left of its {} (GLB_CHUNK_TOO_BIG)",
                                   index, length - offset, chunkBytes));
    }
    const auto chunk = bytes.subspan(offset, chunkBytes);
    if ((index == 0) != (type == kJsonChunk)) {
      throw SceneError(file, "", "exactly one JSON chunk, first in the GLB (GLB_UNEXPECTED_FIRST_CHUNK)");
    }
    if (type == kJsonChunk) chunks.json = chunk;
    if (type == kBinaryChunk) {
      if (hasBinary) throw SceneError(file, "", "at most one BIN chunk in the GLB (GLB_DUPLICATE_CHUNK)");
      chunks.binary = chunk;
      hasBinary = true;
    }
    offset += chunkBytes;
  }
  if (chunks.json.empty()) throw SceneError(file, "", "a JSON chunk with content in the GLB (GLB_EMPTY_CHUNK)");
  return chunks;
}

} // namespace isophote::gltf
