// PNG and Radiance HDR from memory. The only place that knows stb_image.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "scene/image_decode.hpp"

namespace isophote {

[[nodiscard]] bool isRadianceHdr(std::span<const std::byte> bytes);

/// Reads width, height and bits per channel of a PNG into `image`: 16 bits where it has 16, else 8.
[[nodiscard]] DecodeProblem readPngHeader(std::span<const std::byte> bytes, uint64_t maxPixels, ImageData& image);

/// Decodes the pixels, as RGBA, of a PNG whose header was read.
[[nodiscard]] DecodeProblem decodePng(std::span<const std::byte> bytes, ImageData& image);

struct HdrImage {
  uint32_t width = 0;
  uint32_t height = 0;
  std::vector<glm::vec3> pixels; ///< linear, row 0 at the top
};

/// Decodes a Radiance RGBE file.
[[nodiscard]] DecodeProblem decodeHdr(std::span<const std::byte> bytes, uint64_t maxPixels, HdrImage& image);

} // namespace isophote
