#include "input/scene_summary.hpp"

#include "shared/geometry_types.h"

namespace isophote::cli {
namespace {

/// Nodes of up to eight children a triangle.
constexpr double kNodesPerTriangle = 0.15;

uint64_t attributeBytes(const Primitive& primitive) {
  uint64_t bytes = primitive.indices.size() * sizeof(uint32_t);
  bytes += primitive.normals.size() * sizeof(glm::vec3);
  bytes += primitive.tangents.size() * sizeof(glm::vec4);
  bytes += primitive.colors.size() * sizeof(glm::vec4);
  for (const auto& uv : primitive.uvs) bytes += uv.size() * sizeof(glm::vec2);
  return bytes;
}

} // namespace

SceneSummary summarize(const Scene& scene) {
  SceneSummary summary;
  std::vector<uint64_t> meshTriangles;
  std::vector<uint64_t> meshEmissive;
  for (const Mesh& mesh : scene.meshes) {
    uint64_t triangles = 0;
    uint64_t emissive = 0;
    for (const Primitive& primitive : mesh.primitives) {
      const uint64_t count = primitive.indices.size() / 3;
      triangles += count;
      if (scene.materials[primitive.material].emissive != glm::vec3(0)) emissive += count;
      summary.vertices += primitive.positions.size();
      summary.geometryBytes += attributeBytes(primitive) + count * sizeof(gpu::BvhTriangle);
    }
    summary.primitives += mesh.primitives.size();
    summary.triangles += triangles;
    meshTriangles.push_back(triangles);
    meshEmissive.push_back(emissive);
  }
  for (const Instance& instance : scene.instances) {
    summary.instancedTriangles += meshTriangles[instance.mesh];
    summary.emissiveTriangles += meshEmissive[instance.mesh];
  }
  summary.geometryBytes += scene.instances.size() * sizeof(gpu::InstanceRecord);
  const double items = static_cast<double>(summary.triangles + scene.instances.size());
  summary.bvhBytes = static_cast<uint64_t>(items * kNodesPerTriangle * sizeof(gpu::BvhNode));
  for (const ImageData& image : scene.images) summary.textureBytes += image.pixels.size();
  if (scene.environment) summary.environmentBytes = scene.environment->pixels.size() * sizeof(glm::vec3);
  return summary;
}

} // namespace isophote::cli
