// Which meshes of a Scene become one on the device.
#pragma once

#include <cstdint>
#include <vector>

#include "isophote/scene.hpp"

namespace isophote {

/// Meshes of the Scene with one BVH in common.
struct MeshGroup {
  std::vector<uint32_t> meshes; ///< ascending
};

struct GroupPlacement {
  uint32_t group = 0;
  uint32_t instance = 0; ///< of the Scene: the first of those that the placement stands for; all have its map
};

struct MeshGroups {
  std::vector<MeshGroup> groups;          ///< by their first mesh
  std::vector<GroupPlacement> placements; ///< by instance
};

/// Meshes that are placed once, by equal maps, form one group: a ray then walks one tree instead of entering one after
/// another. A mesh that is placed several times is a group of its own; one that is never placed is in none.
[[nodiscard]] MeshGroups groupMeshes(const Scene& scene);

} // namespace isophote
