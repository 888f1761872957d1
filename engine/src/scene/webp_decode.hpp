// WebP from memory. The only place that knows libwebp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "scene/image_decode.hpp"

namespace isophote {

/// Whether this build has libwebp; without it every image is a problem.
[[nodiscard]] bool webpAvailable();

/// Reads width and height; always 8 bits a channel.
[[nodiscard]] DecodeProblem readWebpHeader(std::span<const std::byte> bytes, uint64_t maxPixels, ImageData& image);

/// Decodes the pixels, as RGBA, of an image whose header was read.
[[nodiscard]] DecodeProblem decodeWebp(std::span<const std::byte> bytes, ImageData& image);

} // namespace isophote
