#include "upload/pack_emission.hpp"

#include <algorithm>

namespace isophote {
namespace {

constexpr uint32_t kRows = 6; // 36 congruent parts of a triangle
constexpr double kSmallestShare = 0.01;

// Calls `visit` with the barycentric weights of v1 and v2 at the center of each of kRows^2 congruent parts.
template <class Visit> void forEachPart(Visit visit) {
  for (uint32_t i = 0; i < kRows; ++i) {
    for (uint32_t j = 0; i + j < kRows; ++j) {
      visit((i + 1 / 3.0) / kRows, (j + 1 / 3.0) / kRows);
      if (i + j + 1 < kRows) visit((i + 2 / 3.0) / kRows, (j + 2 / 3.0) / kRows);
    }
  }
}

} // namespace

double luminance(const glm::dvec3& color) { return glm::dot(color, glm::dvec3(0.2126, 0.7152, 0.0722)); }

const TexelReader* EmissionEstimator::texels(const TextureRef& use) {
  if (!use.present()) return nullptr;
  const Texture& texture = scene_.textures[static_cast<size_t>(use.texture)];
  return &readers_.try_emplace(use.texture, scene_.images[texture.image], texture).first->second;
}

glm::dvec3 EmissionEstimator::largestRadiance(const Material& material) {
  const TexelReader* reader = texels(material.emissiveTexture);
  return reader ? glm::dvec3(material.emissive) * glm::dvec3(reader->largest()) : glm::dvec3(material.emissive);
}

double EmissionEstimator::meanLuminance(const Material& material, const Primitive& primitive, uint32_t triangle) {
  const double largest = luminance(largestRadiance(material));
  const TextureRef& use = material.emissiveTexture;
  const TexelReader* reader = texels(use);
  if (!reader) return largest;
  glm::vec2 corners[3] = {};
  const auto& uvs = primitive.uvs[use.uvSet];
  for (uint32_t k = 0; k < 3 && !uvs.empty(); ++k) {
    const glm::vec3 uv(uvs[primitive.indices[3 * static_cast<size_t>(triangle) + k]], 1);
    corners[k] = {glm::dot(use.uRow, uv), glm::dot(use.vRow, uv)};
  }
  glm::dvec3 sum(0);
  forEachPart([&](double b1, double b2) {
    const auto w1 = static_cast<float>(b1);
    const auto w2 = static_cast<float>(b2);
    sum += reader->at(corners[0] + w1 * (corners[1] - corners[0]) + w2 * (corners[2] - corners[0]));
  });
  const double mean = luminance(glm::dvec3(material.emissive) * sum / static_cast<double>(kRows * kRows));
  return std::max(mean, kSmallestShare * largest);
}

} // namespace isophote
