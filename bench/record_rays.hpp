// The rays that the renderer itself traces for one sample of an image, by path vertex.
#pragma once

#include <string>
#include <vector>

#include "isophote/ray_bench.hpp"
#include "isophote/scene.hpp"

namespace isophote::bench {

struct NamedRays {
  std::string name; ///< "primary", "bounce1" to "bounceN", "shadow"
  RayList list;
};

/// One camera ray per pixel and what follows from it: `bounces` generations of BSDF samples, and the shadow rays of the
/// first generation. In the order of the renderer's queues.
[[nodiscard]] std::vector<NamedRays> recordRays(const Device& device, const GpuScene& scene, const Camera& camera,
                                                uint32_t width, uint32_t height, uint32_t bounces);

} // namespace isophote::bench
