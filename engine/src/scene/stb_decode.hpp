// PNG, JPEG and Radiance HDR from memory. The only place that knows stb_image.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "isophote/scene.hpp"

namespace isophote {

enum class ImageFormat : uint32_t { Png, Jpeg };

/// By the first bytes of the file, as the formats define them.
[[nodiscard]] std::optional<ImageFormat> imageFormat(std::span<const std::byte> bytes);
[[nodiscard]] bool isRadianceHdr(std::span<const std::byte> bytes);

/// What went wrong, or success where both are empty.
struct DecodeProblem {
  std::string broken;   ///< not an image of that format, or truncated
  std::string tooLarge; ///< above the pixel limit; found before pixels are allocated
  [[nodiscard]] bool any() const { return !broken.empty() || !tooLarge.empty(); }
};

/// Reads width, height and bits per channel of a PNG or JPEG into `image`: 16 bits where the PNG has 16, else 8.
[[nodiscard]] DecodeProblem readImageHeader(std::span<const std::byte> bytes, uint64_t maxPixels, ImageData& image);

/// Decodes the pixels, as RGBA, of an image whose header was read.
[[nodiscard]] DecodeProblem decodeImage(std::span<const std::byte> bytes, ImageData& image);

struct HdrImage {
  uint32_t width = 0;
  uint32_t height = 0;
  std::vector<glm::vec3> pixels; ///< linear, row 0 at the top
};

/// Decodes a Radiance RGBE file.
[[nodiscard]] DecodeProblem decodeHdr(std::span<const std::byte> bytes, uint64_t maxPixels, HdrImage& image);

} // namespace isophote
