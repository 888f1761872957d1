// The bytes of buffers and buffer views.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/gltf_document.hpp"

namespace isophote::gltf {

class Buffers {
public:
  /// Loads every buffer and checks every buffer view against its buffer.
  /// @throws SceneError, UnsupportedError, LimitError
  explicit Buffers(const Document& document);

  /// The bytes of a buffer view; `index` is a valid one.
  [[nodiscard]] std::span<const std::byte> view(uint32_t index) const { return views_[index]; }

private:
  std::vector<Bytes> owned_;
  std::vector<std::span<const std::byte>> buffers_;
  std::vector<std::span<const std::byte>> views_;
};

} // namespace isophote::gltf
