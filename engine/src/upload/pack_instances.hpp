// The top level: placed meshes, sphere lights, and the BVH over them.
#pragma once

#include <cstdint>
#include <vector>

#include "isophote/settings.hpp"
#include "upload/mesh_groups.hpp"
#include "upload/pack_geometry.hpp"

namespace isophote {

/// Fills packed.instances in the leaf order of the top-level BVH, puts its nodes at the front of packed.nodes (which
/// must be empty), and completes the BVH statistics. Of Backend::RayQuery: meshes in the order of placements, then
/// spheres, and no BVH. Instances of meshes without triangles are left out.
/// @param meshes  of the groups that `placements` names
/// @return per InstanceRecord: GroupPlacement::instance; of a sphere light, in scene.lights
[[nodiscard]] std::vector<uint32_t> packInstances(const Scene& scene, const std::vector<GroupPlacement>& placements,
                                                  const std::vector<PackedMesh>& meshes, Backend backend,
                                                  BvhBuild bvhBuild, PackedScene& packed);

} // namespace isophote
