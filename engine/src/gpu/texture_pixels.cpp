#include "gpu/texture_pixels.hpp"

#include <cmath>
#include <cstring>

namespace isophote::gpu {

double linearFromSrgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

TextureFormat textureFormat(const ImageData& image, bool srgb) {
  if (image.bitsPerChannel == 8) return {srgb ? VK_FORMAT_R8G8B8A8_SRGB : VK_FORMAT_R8G8B8A8_UNORM, 4};
  if (srgb) return {VK_FORMAT_R32G32B32A32_SFLOAT, 16};
  return {VK_FORMAT_R16G16B16A16_UNORM, 8};
}

std::vector<std::byte> texturePixels(const ImageData& image, bool srgb, uint32_t firstRow, uint32_t lastRow) {
  const size_t rowBytes = static_cast<size_t>(image.width) * 4 * (image.bitsPerChannel / 8);
  const std::byte* first = image.pixels.data() + firstRow * rowBytes;
  const std::byte* last = image.pixels.data() + lastRow * rowBytes;
  if (image.bitsPerChannel == 8 || !srgb) return {first, last};

  const size_t values = static_cast<size_t>(lastRow - firstRow) * image.width * 4;
  std::vector<std::byte> pixels(values * sizeof(float));
  for (size_t i = 0; i < values; ++i) {
    uint16_t stored = 0;
    std::memcpy(&stored, first + i * sizeof(stored), sizeof(stored));
    const double encoded = stored / 65535.0;
    const bool isAlpha = i % 4 == 3;
    const float linear = static_cast<float>(isAlpha ? encoded : linearFromSrgb(encoded));
    std::memcpy(pixels.data() + i * sizeof(linear), &linear, sizeof(linear));
  }
  return pixels;
}

} // namespace isophote::gpu
