#include "scene/gltf_buffers.hpp"

#include <optional>

#include <fmt/format.h>

#include "isophote/error.hpp"
#include "scene/checked_math.hpp"
#include "scene/uri.hpp"

namespace isophote::gltf {
namespace {

void checkTotal(const Document& document) {
  uint64_t total = 0;
  for (const Json& buffer : arrayOrEmpty(document.root, "buffers")) {
    const std::optional<uint64_t> sum = checkedAdd(total, buffer.at("byteLength").get<uint64_t>());
    if (!sum || *sum > document.options.maxBufferBytes) {
      throw LimitError(fmt::format("{}: /buffers: more than {} bytes in all buffers together", document.file,
                                   document.options.maxBufferBytes));
    }
    total = *sum;
  }
}

/// The stand-in of EXT_meshopt_compression for a buffer that only its decoder would fill.
bool isEmptyFallback(const Json& buffer) {
  const Json* meshopt = extension(buffer, "EXT_meshopt_compression");
  return !buffer.contains("uri") && meshopt && boolOr(*meshopt, "fallback", false);
}

std::span<const std::byte> loadBuffer(const Document& document, size_t index, Bytes& storage) {
  const Json& buffer = arrayOrEmpty(document.root, "buffers")[index];
  const std::string pointer = fmt::format("/buffers/{}", index);
  const uint64_t byteLength = buffer.at("byteLength").get<uint64_t>();
  std::span<const std::byte> bytes;
  if (buffer.contains("uri")) {
    storage = loadUri(document, buffer.at("uri").get<std::string>(), pointer + "/uri", document.options.maxBufferBytes,
                      byteLength)
                  .bytes;
    bytes = storage;
  } else if (index == 0 && !document.binaryChunk.empty()) {
    bytes = document.binaryChunk;
  } else {
    document.fail(pointer, "a uri, or the BIN chunk of a GLB as the first buffer");
  }
  if (bytes.size() < byteLength) {
    document.fail(pointer + "/byteLength", fmt::format("at most the {} bytes that are there, found {} "
                                                       "(BUFFER_BYTE_LENGTH_MISMATCH)",
                                                       bytes.size(), byteLength));
  }
  return bytes.first(byteLength);
}

} // namespace

Buffers::Buffers(const Document& document) {
  checkTotal(document);
  const Json& buffers = arrayOrEmpty(document.root, "buffers");
  owned_.resize(buffers.size());
  buffers_.resize(buffers.size());
  for (size_t i = 0; i < buffers.size(); ++i) {
    if (!isEmptyFallback(buffers[i])) buffers_[i] = loadBuffer(document, i, owned_[i]);
  }
  const Json& views = arrayOrEmpty(document.root, "bufferViews");
  for (size_t i = 0; i < views.size(); ++i) {
    const uint32_t buffer = *indexOf(views[i], "buffer");
    const uint64_t offset = integerOr(views[i], "byteOffset", 0);
    const uint64_t length = integerOr(views[i], "byteLength", 0);
    if (isEmptyFallback(buffers[buffer])) {
      throw UnsupportedError(document.file, fmt::format("/bufferViews/{}", i),
                             "uncompressed data beside EXT_meshopt_compression, which this build does not offer");
    }
    if (!rangeFits(offset, length, buffers_[buffer].size())) {
      document.fail(fmt::format("/bufferViews/{}", i),
                    fmt::format("a range inside the {} bytes of buffer {}, found offset {} and length {} "
                                "(BUFFER_VIEW_TOO_LONG)",
                                buffers_[buffer].size(), buffer, offset, length));
    }
    views_.push_back(buffers_[buffer].subspan(offset, length));
  }
}

} // namespace isophote::gltf
