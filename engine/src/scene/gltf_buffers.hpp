// The bytes of buffers and buffer views.
#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <span>
#include <string>
#include <vector>

#include "scene/gltf_document.hpp"

namespace isophote::gltf {

class Buffers {
public:
  /// Loads every buffer, checks every buffer view against its buffer, and unpacks the compressed ones.
  /// @throws SceneError, UnsupportedError, LimitError
  explicit Buffers(Document& document);

  /// The bytes of a buffer view; `index` is a valid one.
  [[nodiscard]] std::span<const std::byte> view(uint32_t index) const { return views_[index]; }

private:
  void loadBuffers(const Document& document);
  [[nodiscard]] std::span<const std::byte> range(const Document& document, const Json& json,
                                                 const std::string& pointer) const;
  [[nodiscard]] std::span<const std::byte> loadView(Document& document, const Json& view, const std::string& pointer);

  std::vector<Bytes> owned_;  ///< of each buffer that is not the binary chunk
  std::list<Bytes> unpacked_; ///< of compressed views
  std::vector<std::span<const std::byte>> buffers_;
  std::vector<std::span<const std::byte>> views_;
};

} // namespace isophote::gltf
