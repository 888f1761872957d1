#include "upload/pack_instances.hpp"

#include "upload/pack_bvh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace isophote {
namespace {

// Rows of a double map, rounded.
void setRows(const glm::dmat4& map, gpu::vec4 (&rows)[3]) {
  for (int row = 0; row < 3; ++row) rows[row] = glm::vec4(map[0][row], map[1][row], map[2][row], map[3][row]);
}

gpu::InstanceRecord instanceRecord(const glm::dmat4& worldFromObject, uint32_t number, const PackedMesh& mesh) {
  gpu::InstanceRecord record{};
  setRows(worldFromObject, record.worldFromObject);
  setRows(glm::inverse(worldFromObject), record.objectFromWorld);
  record.rootNode = mesh.rootNode;
  record.firstEmitter = gpu::kInvalidIndex;
  record.mesh = number;
  record.flags = glm::determinant(glm::dmat3(worldFromObject)) < 0 ? gpu::kInstanceMirrored : 0;
  return record;
}

// |linear part| * extent.
glm::dvec3 reach(const glm::vec4 (&rows)[3], glm::dvec3 extent) {
  glm::dvec3 result;
  for (int row = 0; row < 3; ++row) result[row] = glm::dot(glm::abs(glm::dvec3(rows[row])), extent);
  return result;
}

glm::dvec3 translation(const glm::vec4 (&rows)[3]) { return glm::dvec3(rows[0].w, rows[1].w, rows[2].w); }

// World bounds of a placed mesh: of everything that a ray can hit after its origin was rounded to object space. Grown
// as hitPointToWorld in shaders/geometry/ray_offset.glsl does, twice, and rounded outwards.
Box worldBox(const Box& bounds, const gpu::InstanceRecord& record) {
  const glm::dvec3 center = 0.5 * (glm::dvec3(bounds.lower) + glm::dvec3(bounds.upper));
  const glm::dvec3 half = 0.5 * (glm::dvec3(bounds.upper) - glm::dvec3(bounds.lower));
  glm::dvec3 worldCenter = translation(record.worldFromObject);
  for (int row = 0; row < 3; ++row) worldCenter[row] += glm::dot(glm::dvec3(record.worldFromObject[row]), center);
  const glm::dvec3 worldHalf = reach(record.worldFromObject, half);

  constexpr double kRounding = 8 * 1.1920929e-7;
  const glm::dvec3 forward =
      reach(record.worldFromObject, glm::abs(center) + half) + glm::abs(translation(record.worldFromObject));
  const glm::dvec3 back =
      reach(record.objectFromWorld, glm::abs(worldCenter) + worldHalf) + glm::abs(translation(record.objectFromWorld));
  const glm::dvec3 grown = worldHalf + kRounding * (forward + reach(record.worldFromObject, back));
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    box.lower[axis] = std::nextafter(static_cast<float>(worldCenter[axis] - grown[axis]), -kInfinity);
    box.upper[axis] = std::nextafter(static_cast<float>(worldCenter[axis] + grown[axis]), kInfinity);
  }
  return box;
}

gpu::InstanceRecord sphereRecord(const PunctualLight& light, const glm::dvec3& worldOrigin) {
  gpu::InstanceRecord record{};
  record.worldFromObject[0] = glm::vec4(glm::vec3(light.position - worldOrigin), light.radius);
  record.rootNode = gpu::kInvalidIndex;
  record.firstEmitter = gpu::kInvalidIndex;
  record.mesh = gpu::kInvalidIndex;
  record.flags = gpu::kInstanceSphere;
  return record;
}

Box sphereBox(const gpu::InstanceRecord& record) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const glm::vec4 sphere = record.worldFromObject[0];
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    box.lower[axis] = std::nextafter(sphere[axis] - sphere.w, -kInfinity);
    box.upper[axis] = std::nextafter(sphere[axis] + sphere.w, kInfinity);
  }
  return box;
}

// Puts the records into the leaf order of the BVH over them, which it returns.
std::vector<uint32_t> buildTopLevel(const std::vector<PackedMesh>& meshes, std::vector<gpu::InstanceRecord> records,
                                    BvhBuild bvhBuild, PackedScene& packed) {
  std::vector<Box> boxes;
  uint32_t deepestMesh = 0;
  for (const gpu::InstanceRecord& record : records) {
    const bool isSphere = record.flags == gpu::kInstanceSphere;
    boxes.push_back(isSphere ? sphereBox(record) : worldBox(meshes[record.mesh].bounds, record));
    if (!isSphere) deepestMesh = std::max(deepestMesh, meshes[record.mesh].maxDepth);
  }
  // One instance a leaf: entering an instance costs more than a node.
  const WideBvh top = buildTimedBvh(boxes, 1, bvhBuild, packed.bvh);
  packed.nodes = top.nodes;
  packed.bvh.maxDepth = top.maxDepth + deepestMesh;
  packed.bvh.sahCost = top.sahCost;
  for (const uint32_t item : top.order) {
    gpu::InstanceRecord& record = records[item];
    const bool isSphere = record.flags == gpu::kInstanceSphere;
    if (!isSphere) record.rootNode += static_cast<uint32_t>(top.nodes.size());
    packed.instances.push_back(record);
    const double cost = isSphere ? 1 : meshes[record.mesh].sahCost;
    packed.bvh.sahCost += halfArea(boxes[item]) / halfArea(top.bounds) * cost;
  }
  return top.order;
}

} // namespace

std::vector<uint32_t> packInstances(const Scene& scene, const std::vector<GroupPlacement>& placements,
                                    const std::vector<PackedMesh>& meshes, Backend backend, BvhBuild bvhBuild,
                                    PackedScene& packed) {
  std::vector<gpu::InstanceRecord> records;
  std::vector<uint32_t> sceneInstances;
  for (const GroupPlacement& placement : placements) {
    const PackedMesh& mesh = meshes[placement.group];
    if (mesh.triangleCount == 0) continue;
    glm::dmat4 worldFromObject = scene.instances[placement.instance].worldFromObject;
    worldFromObject[3] -= glm::dvec4(packed.worldOrigin, 0);
    records.push_back(instanceRecord(worldFromObject, placement.group, mesh));
    sceneInstances.push_back(placement.instance);
    packed.bvh.instancedTriangles += mesh.triangleCount;
  }
  for (uint32_t i = 0; i < scene.lights.size(); ++i) {
    if (!scene.lights[i].isSphere()) continue;
    records.push_back(sphereRecord(scene.lights[i], packed.worldOrigin));
    sceneInstances.push_back(i);
  }
  if (backend == Backend::RayQuery) {
    packed.instances = std::move(records);
    return sceneInstances;
  }
  if (records.empty()) return {};
  const std::vector<uint32_t> order = buildTopLevel(meshes, std::move(records), bvhBuild, packed);
  std::vector<uint32_t> ordered;
  for (const uint32_t item : order) ordered.push_back(sceneInstances[item]);
  return ordered;
}

} // namespace isophote
