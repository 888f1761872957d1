// Encoded images from memory, by content: PNG and JPEG, and WebP where this build has libwebp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "isophote/scene.hpp"

namespace isophote {

enum class ImageFormat : uint32_t { Png, Jpeg, Webp };

/// By the first bytes of the file, as the formats define them.
[[nodiscard]] std::optional<ImageFormat> imageFormat(std::span<const std::byte> bytes);

/// `image/png` and so on.
[[nodiscard]] const char* mediaType(ImageFormat format);

/// What went wrong, or success where both are empty.
struct DecodeProblem {
  std::string broken;   ///< not an image of that format, or truncated
  std::string tooLarge; ///< above the pixel limit; found before pixels are allocated
  [[nodiscard]] bool any() const { return !broken.empty() || !tooLarge.empty(); }
};

/// The problem of an image above the limit.
[[nodiscard]] DecodeProblem tooManyPixels(uint64_t width, uint64_t height, uint64_t maxPixels);

/// Reads width, height and bits per channel into `image`: 16 bits where a PNG has 16, else 8.
[[nodiscard]] DecodeProblem readImageHeader(std::span<const std::byte> bytes, uint64_t maxPixels, ImageData& image);

/// Decodes the pixels, as RGBA, of an image whose header was read.
[[nodiscard]] DecodeProblem decodeImage(std::span<const std::byte> bytes, ImageData& image);

} // namespace isophote
