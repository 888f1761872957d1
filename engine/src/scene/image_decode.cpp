#include "scene/image_decode.hpp"

#include <cstring>
#include <string_view>

#include <fmt/format.h>

#include "scene/jpeg_decode.hpp"
#include "scene/stb_decode.hpp"
#include "scene/webp_decode.hpp"

namespace isophote {
namespace {

bool hasAt(std::span<const std::byte> bytes, size_t offset, std::string_view magic) {
  return bytes.size() >= offset + magic.size() && std::memcmp(bytes.data() + offset, magic.data(), magic.size()) == 0;
}

} // namespace

std::optional<ImageFormat> imageFormat(std::span<const std::byte> bytes) {
  if (hasAt(bytes, 0, "\x89PNG\r\n\x1a\n")) return ImageFormat::Png;
  if (hasAt(bytes, 0, "\xff\xd8\xff")) return ImageFormat::Jpeg;
  constexpr size_t kRiffTypeOffset = 8;
  if (hasAt(bytes, 0, "RIFF") && hasAt(bytes, kRiffTypeOffset, "WEBP")) return ImageFormat::Webp;
  return std::nullopt;
}

const char* mediaType(ImageFormat format) {
  switch (format) {
  case ImageFormat::Png:
    return "image/png";
  case ImageFormat::Jpeg:
    return "image/jpeg";
  case ImageFormat::Webp:
    break;
  }
  return "image/webp";
}

DecodeProblem tooManyPixels(uint64_t width, uint64_t height, uint64_t maxPixels) {
  return {.broken = {}, .tooLarge = fmt::format("{} x {} pixels, the limit is {} pixels", width, height, maxPixels)};
}

DecodeProblem readImageHeader(std::span<const std::byte> bytes, uint64_t maxPixels, ImageData& image) {
  const std::optional<ImageFormat> format = imageFormat(bytes);
  if (!format) return {.broken = "it is neither PNG nor JPEG nor WebP", .tooLarge = {}};
  switch (*format) {
  case ImageFormat::Png:
    return readPngHeader(bytes, maxPixels, image);
  case ImageFormat::Jpeg:
    return readJpegHeader(bytes, maxPixels, image);
  case ImageFormat::Webp:
    break;
  }
  return readWebpHeader(bytes, maxPixels, image);
}

DecodeProblem decodeImage(std::span<const std::byte> bytes, ImageData& image) {
  switch (imageFormat(bytes).value()) {
  case ImageFormat::Png:
    return decodePng(bytes, image);
  case ImageFormat::Jpeg:
    return decodeJpeg(bytes, image);
  case ImageFormat::Webp:
    break;
  }
  return decodeWebp(bytes, image);
}

} // namespace isophote
