// Recorded rays, and how fast a device traces them: one kernel alone, on input that other tracers can be given too.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include <glm/glm.hpp>

#include "isophote/gpu_scene.hpp"

namespace isophote {

/// World space, metres; a surface counts where tMin <= t < tMax in units of the direction's length.
struct Ray {
  glm::vec3 origin;
  float tMin;
  glm::vec3 direction;
  float tMax;
};

enum class RayQuestion : uint32_t {
  ClosestHit, ///< which surface comes first
  Occluded    ///< whether there is any
};

struct RayList {
  RayQuestion question = RayQuestion::ClosestHit;
  std::vector<Ray> rays;
};

/// Little-endian: 8 bytes "IsoRays1", uint32 question, uint32 0, uint64 count, then 32 bytes a ray as in Ray.
/// @throws SceneError where the file is not such a file
[[nodiscard]] RayList readRays(const std::filesystem::path& path);
/// @throws OutputError
void writeRays(const std::filesystem::path& path, const RayList& list);

struct RayTimes {
  std::vector<double> seconds; ///< of each repetition over the whole list, the first (warm-up) left out
  uint64_t hits = 0;           ///< rays that met a surface
};

/// Traces the list again and again for about `seconds` (at least three times), with the scene's own kernels.
[[nodiscard]] RayTimes timeRays(const Device& device, const GpuScene& scene, const RayList& list, double seconds);

} // namespace isophote
