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

/// Images keep their bits, with two exceptions: 16-bit sRGB becomes linear float32, since Vulkan has no such format,
/// and where `widen` is set, 8-bit linear images become 16-bit ones of the same values.
///
/// @param widen  for software devices: llvmpipe (Mesa 25) rounds what it filters from 8-bit linear images to 8 bits,
/// which
///               bands every normal map; 16-bit ones it filters in float (measured: 24 ns more a random read, nothing
///               for coherent ones)
[[nodiscard]] TextureFormat textureFormat(const ImageData& image, bool srgb, bool widen);

/// Rows [firstRow, lastRow) in that format.
[[nodiscard]] std::vector<std::byte> texturePixels(const ImageData& image, VkFormat format, uint32_t firstRow,
                                                   uint32_t lastRow);

/// The sRGB decoding of IEC 61966-2-1, `encoded` in [0, 1].
[[nodiscard]] double linearFromSrgb(double encoded);

} // namespace isophote::gpu
