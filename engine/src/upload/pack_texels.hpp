// Decoded texels of an image on the host, for what packing must know of a texture's content.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "isophote/scene.hpp"

namespace isophote {

/// Reads sRGB texels at texture coordinates, nearest, as linear values. Borrows the Scene's image.
class TexelReader {
public:
  TexelReader(const ImageData& image, const Texture& texture);

  /// The texel at uv (0, 0 is the corner of the image's first pixel), wrapped as the texture says.
  [[nodiscard]] glm::vec3 at(glm::vec2 uv) const;

  /// The largest value of each channel in the image: no filtered read exceeds it.
  [[nodiscard]] glm::vec3 largest() const { return largest_; }

private:
  const ImageData* image_;
  Wrap wrapS_, wrapT_;
  std::vector<float> decoded_; // linear value of every stored one
  glm::vec3 largest_{0};
};

/// Whether the alpha of every pixel is 1.
[[nodiscard]] bool isOpaqueImage(const ImageData& image);

} // namespace isophote
