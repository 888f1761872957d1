// A path tracer in double precision, written to be believed on reading. It shares the Scene with the engine and no
// code.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "isophote/scene.hpp"
#include "isophote/settings.hpp"

namespace isophote::oracle {

struct ReferenceSettings {
  uint32_t maxDepth = kUnlimitedDepth;              ///< scattering events; unlimited paths end by Russian roulette
  LightSampling lightSampling = LightSampling::Mis; ///< with the balance heuristic
  uint64_t seed = 1;
  uint32_t threads = 0; ///< 0: all cores; the result does not depend on it
};

struct ReferencePixel {
  glm::dvec3 mean{0};
  glm::dvec3 standardError{0}; ///< of the mean, from independent samples
};

struct ReferenceImage {
  uint32_t width = 0;
  uint32_t height = 0;
  uint32_t samplesPerPixel = 0;
  std::vector<ReferencePixel> pixels; ///< row 0 at the top

  [[nodiscard]] const ReferencePixel& at(uint32_t x, uint32_t y) const { return pixels[size_t{y} * width + x]; }
};

/// Renders with a box pixel filter and independent random numbers.
/// @throws UsageError for empty images or fewer than 2 samples, of which no standard error can be taken
[[nodiscard]] ReferenceImage renderReference(const Scene& scene, const Camera& camera, uint32_t width, uint32_t height,
                                             uint32_t samplesPerPixel, const ReferenceSettings& settings = {});

} // namespace isophote::oracle
