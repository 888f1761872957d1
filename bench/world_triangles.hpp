// Every triangle of every instance in one list, for tracers without instances.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "isophote/scene.hpp"
#include "isophote/settings.hpp"

namespace isophote::bench {

struct WorldTriangles {
  std::vector<glm::vec3> corners;       ///< three per triangle, world space
  std::vector<uint32_t> instanceOffset; ///< per device instance: add the device's triangle number for a list number

  [[nodiscard]] uint32_t number(uint32_t deviceInstance, uint32_t deviceTriangle) const {
    return instanceOffset[deviceInstance] + deviceTriangle;
  }
};

/// As GpuScene numbers them.
[[nodiscard]] WorldTriangles worldTriangles(const Scene& scene, Backend backend, BvhBuild build);

/// Where along the ray its line meets the plane of a triangle.
[[nodiscard]] double planeDistance(const glm::vec3 (&corners)[3], glm::dvec3 origin, glm::dvec3 direction);

} // namespace isophote::bench
