#include "scene/gltf_buffers.hpp"

#include <optional>

#include <fmt/format.h>

#include "isophote/error.hpp"
#include "scene/checked_math.hpp"
#include "scene/gltf_meshopt.hpp"
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

Buffers::Buffers(Document& document) {
  loadBuffers(document);
  const Json& views = arrayOrEmpty(document.root, "bufferViews");
  for (size_t i = 0; i < views.size(); ++i) {
    views_.push_back(loadView(document, views[i], fmt::format("/bufferViews/{}", i)));
  }
}

void Buffers::loadBuffers(const Document& document) {
  checkTotal(document);
  const Json& buffers = arrayOrEmpty(document.root, "buffers");
  owned_.resize(buffers.size());
  buffers_.resize(buffers.size());
  for (size_t i = 0; i < buffers.size(); ++i) {
    if (!isEmptyMeshoptFallback(buffers[i])) buffers_[i] = loadBuffer(document, i, owned_[i]);
  }
}

std::span<const std::byte> Buffers::range(const Document& document, const Json& json,
                                          const std::string& pointer) const {
  const uint32_t buffer = *indexOf(json, "buffer");
  const uint64_t offset = integerOr(json, "byteOffset", 0);
  const uint64_t length = integerOr(json, "byteLength", 0);
  if (!rangeFits(offset, length, buffers_[buffer].size())) {
    document.fail(pointer, fmt::format("a range inside the {} bytes of buffer {}, found offset {} and length {} "
                                       "(BUFFER_VIEW_TOO_LONG)",
                                       buffers_[buffer].size(), buffer, offset, length));
  }
  return buffers_[buffer].subspan(offset, length);
}

std::span<const std::byte> Buffers::loadView(Document& document, const Json& view, const std::string& pointer) {
  const MeshoptExtension meshopt = meshoptExtension(view, pointer);
  if (!meshopt.json) return range(document, view, pointer);
  const std::span<const std::byte> packed = range(document, *meshopt.json, meshopt.pointer);
  if (!offersMeshopt(*meshopt.json, packed)) {
    const bool hasFallback = !isEmptyMeshoptFallback(document.root.at("buffers")[*indexOf(view, "buffer")]);
    if (hasFallback) return range(document, view, pointer);
    throw UnsupportedError(document.file, meshopt.pointer,
                           "uncompressed data beside compression of a kind that this build does not offer");
  }
  return unpacked_.emplace_back(unpackMeshopt(document, view, meshopt, packed));
}

} // namespace isophote::gltf
