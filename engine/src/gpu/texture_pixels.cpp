#include "gpu/texture_pixels.hpp"

#include <cmath>
#include <cstring>
#include <span>

namespace isophote::gpu {
namespace {

/// 8 to 16 bits: v / 255 = 257 v / 65535, and 257 v is the byte twice.
std::vector<std::byte> widened(std::span<const std::byte> values) {
  std::vector<std::byte> pixels(2 * values.size());
  for (size_t i = 0; i < values.size(); ++i) pixels[2 * i] = pixels[2 * i + 1] = values[i];
  return pixels;
}

/// 16-bit sRGB to linear float; alpha is linear already.
std::vector<std::byte> decoded(std::span<const std::byte> values) {
  const size_t count = values.size() / sizeof(uint16_t);
  std::vector<std::byte> pixels(count * sizeof(float));
  for (size_t i = 0; i < count; ++i) {
    uint16_t stored = 0;
    std::memcpy(&stored, values.data() + i * sizeof(stored), sizeof(stored));
    const double encoded = stored / 65535.0;
    const bool isAlpha = i % 4 == 3;
    const float linear = static_cast<float>(isAlpha ? encoded : linearFromSrgb(encoded));
    std::memcpy(pixels.data() + i * sizeof(linear), &linear, sizeof(linear));
  }
  return pixels;
}

} // namespace

double linearFromSrgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

TextureFormat textureFormat(const ImageData& image, bool srgb, bool widen) {
  if (image.bitsPerChannel == 8 && srgb) return {VK_FORMAT_R8G8B8A8_SRGB, 4};
  if (image.bitsPerChannel == 8 && !widen) return {VK_FORMAT_R8G8B8A8_UNORM, 4};
  if (srgb) return {VK_FORMAT_R32G32B32A32_SFLOAT, 16};
  return {VK_FORMAT_R16G16B16A16_UNORM, 8};
}

std::vector<std::byte> texturePixels(const ImageData& image, VkFormat format, uint32_t firstRow, uint32_t lastRow) {
  const size_t rowBytes = static_cast<size_t>(image.width) * 4 * (image.bitsPerChannel / 8);
  const std::span<const std::byte> rows(image.pixels.data() + firstRow * rowBytes, (lastRow - firstRow) * rowBytes);
  if (image.bitsPerChannel == 8 && format == VK_FORMAT_R16G16B16A16_UNORM) return widened(rows);
  if (format == VK_FORMAT_R32G32B32A32_SFLOAT) return decoded(rows);
  return {rows.begin(), rows.end()};
}

} // namespace isophote::gpu
