// How much light the triangles of a material give off.
#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "isophote/scene.hpp"
#include "upload/pack_texels.hpp"

namespace isophote {

[[nodiscard]] double luminance(const glm::dvec3& color); ///< Rec.709

/// Estimates emission from factors and textures. Keeps what it decoded; borrows the Scene.
class EmissionEstimator {
public:
  explicit EmissionEstimator(const Scene& scene) : scene_(scene) {}

  /// Mean luminance of the radiance over a triangle: of 36 texels spread evenly over it, never below 1% of what the
  /// brightest texel could give, so that it is positive wherever the triangle's emission can be.
  [[nodiscard]] double meanLuminance(const Material& material, const Primitive& primitive, uint32_t triangle);

  /// Per channel an upper bound of the material's radiance.
  [[nodiscard]] glm::dvec3 largestRadiance(const Material& material);

private:
  const TexelReader* texels(const TextureRef& use);

  const Scene& scene_;
  std::map<int32_t, TexelReader> readers_; // by texture
};

} // namespace isophote
