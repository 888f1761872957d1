// Triangles, attributes and both levels of BVH.
#pragma once

#include <cstdint>
#include <vector>

#include "accel/bvh.hpp"
#include "isophote/settings.hpp"
#include "upload/pack_materials.hpp"
#include "upload/pack_scene.hpp"

namespace isophote {

/// Where an emissive triangle of a mesh is.
struct MeshEmitter {
  uint32_t triangle = 0;       ///< index into PackedScene::triangles
  uint32_t mesh = 0;           ///< of the Scene
  uint32_t primitive = 0;      ///< of that mesh
  uint32_t primitiveIndex = 0; ///< triangle number within it
};

/// What stands in PackedScene for one group of meshes (mesh_groups.hpp).
struct PackedMesh {
  uint32_t rootNode = gpu::kInvalidIndex; ///< relative to the first mesh node; kInvalidIndex: no BVH
  uint32_t triangleCount = 0;
  uint32_t maxDepth = 0;
  double sahCost = 0;
  Box bounds;
  std::vector<MeshEmitter> emitters; ///< by mesh, primitive, then triangle number
};

struct PackedGeometry {
  std::vector<PackedMesh> meshes;       ///< as InstanceRecord::mesh counts them
  std::vector<uint32_t> sceneInstances; ///< per InstanceRecord: its index in Scene::instances, the first of a
                                        ///< group's; of a sphere light, in Scene::lights
};

/// Meshes that an instance refers to.
[[nodiscard]] std::vector<bool> usedMeshes(const Scene& scene);

/// Fills nodes or triangle ranges, triangles, geometries, attributes, instances (without firstEmitter) and the BVH
/// statistics. Reads packed.worldOrigin.
/// @throws LimitError where an index of the device format would overflow
[[nodiscard]] PackedGeometry packGeometry(const Scene& scene, const std::vector<bool>& meshUsed,
                                          const PackedMaterials& materials, Backend backend, BvhBuild bvhBuild,
                                          PackedScene& packed);

} // namespace isophote
