// JPEG from memory. The only place that knows libjpeg-turbo.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "scene/image_decode.hpp"

namespace isophote {

/// Reads width and height; always 8 bits a channel.
[[nodiscard]] DecodeProblem readJpegHeader(std::span<const std::byte> bytes, uint64_t maxPixels, ImageData& image);

/// Decodes the pixels, as RGBA, of an image whose header was read.
[[nodiscard]] DecodeProblem decodeJpeg(std::span<const std::byte> bytes, ImageData& image);

} // namespace isophote
