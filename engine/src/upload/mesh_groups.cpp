#include "upload/mesh_groups.hpp"

#include <algorithm>
#include <array>
#include <map>

namespace isophote {
namespace {

using MapKey = std::array<double, 16>;

MapKey keyOf(const glm::dmat4& map) {
  MapKey key;
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) key[4 * column + row] = map[column][row];
  }
  return key;
}

} // namespace

MeshGroups groupMeshes(const Scene& scene) {
  std::vector<uint32_t> uses(scene.meshes.size()), firstUse(scene.meshes.size());
  for (auto i = static_cast<uint32_t>(scene.instances.size()); i-- > 0;) {
    ++uses[scene.instances[i].mesh];
    firstUse[scene.instances[i].mesh] = i;
  }
  MeshGroups result;
  std::vector<uint32_t> groupOf(scene.meshes.size());
  std::map<MapKey, uint32_t> groupAt;
  for (uint32_t mesh = 0; mesh < scene.meshes.size(); ++mesh) {
    if (uses[mesh] == 0) continue;
    const auto next = static_cast<uint32_t>(result.groups.size());
    groupOf[mesh] = next;
    if (uses[mesh] == 1) {
      groupOf[mesh] = groupAt.try_emplace(keyOf(scene.instances[firstUse[mesh]].worldFromObject), next).first->second;
    }
    if (groupOf[mesh] == next) result.groups.emplace_back();
    result.groups[groupOf[mesh]].meshes.push_back(mesh);
  }
  std::vector<bool> placed(result.groups.size());
  for (uint32_t i = 0; i < scene.instances.size(); ++i) {
    const uint32_t mesh = scene.instances[i].mesh;
    const uint32_t group = groupOf[mesh];
    if (uses[mesh] > 1 || !placed[group]) result.placements.push_back({group, i});
    placed[group] = true;
  }
  return result;
}

} // namespace isophote
