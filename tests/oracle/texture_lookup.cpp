#include "oracle/texture_lookup.hpp"

#include <array>
#include <cmath>

namespace isophote::oracle {

double decodeSrgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

namespace {

std::array<double, 256> decodeTable() {
  std::array<double, 256> table{};
  for (size_t i = 0; i < table.size(); ++i) table[i] = decodeSrgb(static_cast<double>(i) / 255);
  return table;
}

double channelValue(const ImageData& image, size_t index, bool srgb) {
  static const std::array<double, 256> kDecoded = decodeTable();
  if (image.bitsPerChannel == 8) {
    const auto value = std::to_integer<uint8_t>(image.pixels[index]);
    return srgb ? kDecoded[value] : value / 255.0;
  }
  const auto low = std::to_integer<uint32_t>(image.pixels[2 * index]);
  const auto high = std::to_integer<uint32_t>(image.pixels[2 * index + 1]);
  const double value = (low | high << 8) / 65535.0;
  return srgb ? decodeSrgb(value) : value;
}

} // namespace

glm::dvec4 readTexel(const ImageData& image, uint32_t x, uint32_t y, Encoding encoding) {
  const size_t first = (static_cast<size_t>(y) * image.width + x) * 4;
  const bool srgb = encoding == Encoding::Srgb;
  return {channelValue(image, first, srgb), channelValue(image, first + 1, srgb), channelValue(image, first + 2, srgb),
          channelValue(image, first + 3, false)};
}

uint32_t wrapTexel(int64_t index, uint32_t size, Wrap wrap) {
  const auto count = static_cast<int64_t>(size);
  const auto modulo = [&](int64_t period) { return ((index % period) + period) % period; };
  switch (wrap) {
  case Wrap::Repeat:
    return static_cast<uint32_t>(modulo(count));
  case Wrap::ClampToEdge:
    return static_cast<uint32_t>(index < 0 ? 0 : index >= count ? count - 1 : index);
  case Wrap::MirroredRepeat:
    break;
  }
  const int64_t position = modulo(2 * count);
  return static_cast<uint32_t>(position < count ? position : 2 * count - 1 - position);
}

glm::dvec4 lookUp(const Scene& scene, const Texture& texture, glm::dvec2 uv, Encoding encoding) {
  const ImageData& image = scene.images[texture.image];
  const auto texel = [&](double column, double row) {
    return readTexel(image, wrapTexel(static_cast<int64_t>(column), image.width, texture.wrapS),
                     wrapTexel(static_cast<int64_t>(row), image.height, texture.wrapT), encoding);
  };
  const glm::dvec2 position = uv * glm::dvec2(image.width, image.height);
  if (texture.filter == Filter::Nearest) return texel(std::floor(position.x), std::floor(position.y));
  const glm::dvec2 corner = glm::floor(position - 0.5);
  const glm::dvec2 f = position - 0.5 - corner;
  const glm::dvec4 upper = glm::mix(texel(corner.x, corner.y), texel(corner.x + 1, corner.y), f.x);
  const glm::dvec4 lower = glm::mix(texel(corner.x, corner.y + 1), texel(corner.x + 1, corner.y + 1), f.x);
  return glm::mix(upper, lower, f.y);
}

glm::dvec4 lookUp(const Scene& scene, const TextureRef& reference, glm::dvec2 meshUv, Encoding encoding) {
  const glm::dvec3 uv1(meshUv, 1);
  const glm::dvec2 uv(glm::dot(glm::dvec3(reference.uRow), uv1), glm::dot(glm::dvec3(reference.vRow), uv1));
  return lookUp(scene, scene.textures[static_cast<size_t>(reference.texture)], uv, encoding);
}

} // namespace isophote::oracle
