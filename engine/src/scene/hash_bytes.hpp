// A hash for plain bytes: FNV-1a (Fowler, Noll, Vo 1991; offset basis and prime of the 64-bit variant) over words,
// with the finalizer of MurmurHash3 (Appleby 2011), since whole words mix too little.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace isophote {

/// @param bytes  a multiple of 4
[[nodiscard]] inline uint64_t hashBytes(const void* data, size_t bytes) {
  uint64_t hash = 0xcbf29ce484222325ull;
  const auto* from = static_cast<const unsigned char*>(data);
  for (size_t i = 0; i + 4 <= bytes; i += 4) {
    uint32_t word = 0;
    std::memcpy(&word, from + i, sizeof(word));
    hash = (hash ^ word) * 0x100000001b3ull;
  }
  hash = (hash ^ hash >> 33) * 0xff51afd7ed558ccdull;
  hash = (hash ^ hash >> 33) * 0xc4ceb9fe1a85ec53ull;
  return hash ^ hash >> 33;
}

} // namespace isophote
