#include "upload/pack_texels.hpp"

#include "gpu/texture_pixels.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace isophote {
namespace {

uint32_t storedValue(const ImageData& image, size_t value) {
  if (image.bitsPerChannel == 8) return std::to_integer<uint32_t>(image.pixels[value]);
  return std::to_integer<uint32_t>(image.pixels[2 * value]) | std::to_integer<uint32_t>(image.pixels[2 * value + 1])
                                                                  << 8;
}

// The pixel that holds coordinate `u` on an axis of `size` pixels (Vulkan 1.3, section 16.8, nearest filter).
uint32_t wrappedPixel(float u, uint32_t size, Wrap wrap) {
  if (!std::isfinite(u)) return 0;
  double unit = u;
  switch (wrap) {
  case Wrap::Repeat:
    unit -= std::floor(unit);
    break;
  case Wrap::MirroredRepeat:
    unit = std::abs(unit - 2 * std::floor(0.5 * unit + 0.5));
    break;
  case Wrap::ClampToEdge:
    break;
  }
  return static_cast<uint32_t>(std::clamp(std::floor(unit * size), 0.0, size - 1.0));
}

} // namespace

TexelReader::TexelReader(const ImageData& image, const Texture& texture)
    : image_(&image), wrapS_(texture.wrapS), wrapT_(texture.wrapT) {
  const uint32_t limit = image.bitsPerChannel == 8 ? 255 : 65535;
  decoded_.resize(limit + 1);
  for (uint32_t i = 0; i <= limit; ++i) decoded_[i] = static_cast<float>(gpu::linearFromSrgb(i / double(limit)));

  std::array<uint32_t, 3> largest{};
  const size_t pixels = static_cast<size_t>(image.width) * image.height;
  for (size_t i = 0; i < pixels; ++i) {
    for (size_t c = 0; c < 3; ++c) largest[c] = std::max(largest[c], storedValue(image, 4 * i + c));
  }
  largest_ = {decoded_[largest[0]], decoded_[largest[1]], decoded_[largest[2]]};
}

glm::vec3 TexelReader::at(glm::vec2 uv) const {
  const size_t column = wrappedPixel(uv.x, image_->width, wrapS_);
  const size_t first = 4 * (wrappedPixel(uv.y, image_->height, wrapT_) * static_cast<size_t>(image_->width) + column);
  return {decoded_[storedValue(*image_, first)], decoded_[storedValue(*image_, first + 1)],
          decoded_[storedValue(*image_, first + 2)]};
}

bool isOpaqueImage(const ImageData& image) {
  const uint32_t limit = image.bitsPerChannel == 8 ? 255 : 65535;
  const size_t pixels = static_cast<size_t>(image.width) * image.height;
  for (size_t i = 0; i < pixels; ++i) {
    if (storedValue(image, 4 * i + 3) != limit) return false;
  }
  return true;
}

} // namespace isophote
