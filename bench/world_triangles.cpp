#include "world_triangles.hpp"

#include "upload/pack_scene.hpp"

namespace isophote::bench {

WorldTriangles worldTriangles(const Scene& scene, Backend backend, BvhBuild build) {
  const PackedScene packed = packScene(scene, backend, build); // as GpuScene does, so with the same numbers
  WorldTriangles result;
  for (const gpu::InstanceRecord& instance : packed.instances) {
    const uint32_t first = packed.meshTriangles[instance.mesh];
    result.instanceOffset.push_back(static_cast<uint32_t>(result.corners.size() / 3) - first);
    for (uint32_t i = first; i < packed.meshTriangles[instance.mesh + 1]; ++i) {
      const gpu::BvhTriangle& triangle = packed.triangles[i];
      for (const glm::vec3& corner : {triangle.v0, triangle.v1, triangle.v2}) {
        glm::dvec3 world;
        for (int row = 0; row < 3; ++row) {
          world[row] = glm::dot(glm::dvec4(instance.worldFromObject[row]), glm::dvec4(corner, 1));
        }
        result.corners.emplace_back(world + packed.worldOrigin);
      }
    }
  }
  return result;
}

double planeDistance(const glm::vec3 (&corners)[3], glm::dvec3 origin, glm::dvec3 direction) {
  const glm::dvec3 a(corners[0]);
  const glm::dvec3 normal = glm::cross(glm::dvec3(corners[1]) - a, glm::dvec3(corners[2]) - a);
  return glm::dot(a - origin, normal) / glm::dot(direction, normal);
}

} // namespace isophote::bench
