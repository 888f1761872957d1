// Unsigned arithmetic that says when it would wrap.
#pragma once

#include <cstdint>
#include <optional>

namespace isophote {

[[nodiscard]] inline std::optional<uint64_t> checkedAdd(uint64_t a, uint64_t b) {
  if (a > UINT64_MAX - b) return std::nullopt;
  return a + b;
}

[[nodiscard]] inline std::optional<uint64_t> checkedMultiply(uint64_t a, uint64_t b) {
  if (b != 0 && a > UINT64_MAX / b) return std::nullopt;
  return a * b;
}

/// True where [offset, offset + length) lies inside [0, size).
[[nodiscard]] inline bool rangeFits(uint64_t offset, uint64_t length, uint64_t size) {
  return offset <= size && length <= size - offset;
}

} // namespace isophote
