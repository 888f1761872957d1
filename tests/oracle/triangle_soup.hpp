// A scene's triangles in world space: every instance flattened, everything in double.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "isophote/scene.hpp"

namespace isophote::oracle {

struct Triangle {
  glm::dvec3 v0{0};
  glm::dvec3 edge1{0}; ///< v1 - v0
  glm::dvec3 edge2{0}; ///< v2 - v0
  glm::dvec3 ng{
      0}; ///< unit, on the front side: counter-clockwise in object space, so mirrored instances keep their front
  double area = 0;
  uint32_t instance = 0;
  uint32_t primitive = 0; ///< within the instance's mesh
  uint32_t index = 0;     ///< within the primitive
  uint32_t material = 0;
  bool opaque = true; ///< no alpha test
};

/// Triangles of zero area are left out.
[[nodiscard]] std::vector<Triangle> flattenScene(const Scene& scene);

} // namespace isophote::oracle
