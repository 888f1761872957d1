// PNG files of every color type and depth, for decoder tests: stored (uncompressed) blocks.
// Source: W3C PNG Specification (3rd edition), RFC 1950 (zlib), RFC 1951 (deflate).
#pragma once

#include <cstdint>
#include <string>

namespace isophote::test {

struct PngContent {
  uint32_t width = 1;
  uint32_t height = 1;
  int bitDepth = 8;
  int colorType = 6;   ///< 0 gray, 2 RGB, 3 palette, 4 gray and alpha, 6 RGBA
  std::string rows;    ///< samples of all rows, most significant byte first, without filter bytes
  std::string palette; ///< RGB triples, for color type 3
};

inline std::string bigEndian32(uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 0xffu);
  return bytes;
}

inline uint32_t crc32(const std::string& bytes) {
  uint32_t crc = 0xffffffffu;
  for (const char c : bytes) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) crc = crc & 1u ? crc >> 1 ^ 0xedb88320u : crc >> 1;
  }
  return ~crc;
}

inline std::string pngChunk(const std::string& type, const std::string& content) {
  return bigEndian32(static_cast<uint32_t>(content.size())) + type + content + bigEndian32(crc32(type + content));
}

/// zlib data in one stored block; `bytes` below 64 KiB.
inline std::string storedZlib(const std::string& bytes) {
  uint32_t a = 1;
  uint32_t b = 0;
  for (const char c : bytes) {
    a = (a + static_cast<unsigned char>(c)) % 65521;
    b = (b + a) % 65521;
  }
  const auto size = static_cast<uint32_t>(bytes.size());
  std::string result = "\x78\x01\x01";
  for (const uint32_t value : {size, ~size}) {
    result += static_cast<char>(value & 0xffu);
    result += static_cast<char>(value >> 8 & 0xffu);
  }
  return result + bytes + bigEndian32(b << 16 | a);
}

inline std::string pngHeader(uint32_t width, uint32_t height, int bitDepth, int colorType) {
  return "\x89PNG\r\n\x1a\n" + pngChunk("IHDR", bigEndian32(width) + bigEndian32(height) + static_cast<char>(bitDepth) +
                                                    static_cast<char>(colorType) + std::string(3, '\0'));
}

inline std::string png(const PngContent& content) {
  const size_t rowBytes = content.rows.size() / content.height;
  std::string filtered;
  for (uint32_t row = 0; row < content.height; ++row) filtered += '\0' + content.rows.substr(row * rowBytes, rowBytes);
  std::string file = pngHeader(content.width, content.height, content.bitDepth, content.colorType);
  if (!content.palette.empty()) file += pngChunk("PLTE", content.palette);
  return file + pngChunk("IDAT", storedZlib(filtered)) + pngChunk("IEND", "");
}

/// One RGBA pixel.
inline std::string pngPixel(uint8_t r, uint8_t g, uint8_t b, uint8_t a) {
  return png({.rows = {static_cast<char>(r), static_cast<char>(g), static_cast<char>(b), static_cast<char>(a)}});
}

} // namespace isophote::test
