// Which Vulkan format holds an image, and its pixels in that format.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <vulkan/vulkan.h>

#include "isophote/scene.hpp"

namespace isophote::gpu {

struct TextureFormat {
  VkFormat format = VK_FORMAT_UNDEFINED;
  uint32_t bytesPerPixel = 0;
};

/// 8-bit images keep their bits; 16-bit linear ones too; 16-bit sRGB becomes linear float32, since Vulkan has no such
/// format.
[[nodiscard]] TextureFormat textureFormat(const ImageData& image, bool srgb);

/// Rows [firstRow, lastRow) in that format.
[[nodiscard]] std::vector<std::byte> texturePixels(const ImageData& image, bool srgb, uint32_t firstRow,
                                                   uint32_t lastRow);

/// The sRGB decoding of IEC 61966-2-1, `encoded` in [0, 1].
[[nodiscard]] double linearFromSrgb(double encoded);

} // namespace isophote::gpu
