#include "scene/webp_decode.hpp"

#ifdef ISOPHOTE_HAS_WEBP

#include <webp/decode.h>

namespace isophote {
namespace {

constexpr uint64_t kChannels = 4;

const uint8_t* data(std::span<const std::byte> bytes) { return reinterpret_cast<const uint8_t*>(bytes.data()); }

} // namespace

bool webpAvailable() { return true; }

DecodeProblem readWebpHeader(std::span<const std::byte> bytes, uint64_t maxPixels, ImageData& image) {
  WebPBitstreamFeatures features{};
  if (WebPGetFeatures(data(bytes), bytes.size(), &features) != VP8_STATUS_OK) {
    return {.broken = "its header cannot be read", .tooLarge = {}};
  }
  if (features.has_animation) return {.broken = "it is an animation", .tooLarge = {}};
  const auto width = static_cast<uint64_t>(features.width); // at most 2^14 a side
  const auto height = static_cast<uint64_t>(features.height);
  if (width * height > maxPixels) return tooManyPixels(width, height, maxPixels);
  image.width = static_cast<uint32_t>(width);
  image.height = static_cast<uint32_t>(height);
  image.bitsPerChannel = 8;
  return {};
}

DecodeProblem decodeWebp(std::span<const std::byte> bytes, ImageData& image) {
  const uint64_t rowBytes = image.width * kChannels;
  image.pixels.resize(rowBytes * image.height);
  auto* pixels = reinterpret_cast<uint8_t*>(image.pixels.data());
  if (!WebPDecodeRGBAInto(data(bytes), bytes.size(), pixels, image.pixels.size(), static_cast<int>(rowBytes))) {
    return {.broken = "it cannot be decoded or is truncated", .tooLarge = {}};
  }
  return {};
}

} // namespace isophote

#else

namespace isophote {

bool webpAvailable() { return false; }
DecodeProblem readWebpHeader(std::span<const std::byte>, uint64_t, ImageData&) {
  return {.broken = "this build has no WebP", .tooLarge = {}};
}
DecodeProblem decodeWebp(std::span<const std::byte>, ImageData&) {
  return {.broken = "this build has no WebP", .tooLarge = {}};
}

} // namespace isophote

#endif
