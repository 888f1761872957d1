#include "upload/mesh_groups.hpp"

#include <gtest/gtest.h>

using namespace isophote;

namespace {

glm::dmat4 at(double x) {
  glm::dmat4 map(1);
  map[3].x = x;
  return map;
}

Scene placed(uint32_t meshes, std::vector<Instance> instances) {
  Scene scene;
  scene.meshes.resize(meshes);
  scene.instances = std::move(instances);
  return scene;
}

} // namespace

TEST(MeshGroups, MeshesPlacedOnceByTheSameMapAreOne) {
  const MeshGroups groups = groupMeshes(placed(4, {{3, at(1), {}}, {0, at(1), {}}, {1, at(2), {}}, {2, at(1), {}}}));
  ASSERT_EQ(groups.groups.size(), 2u);
  EXPECT_EQ(groups.groups[0].meshes, (std::vector<uint32_t>{0, 2, 3}));
  EXPECT_EQ(groups.groups[1].meshes, (std::vector<uint32_t>{1}));
  ASSERT_EQ(groups.placements.size(), 2u);
  EXPECT_EQ(groups.placements[0].group, 0u);
  EXPECT_EQ(groups.placements[0].instance, 0u);
  EXPECT_EQ(groups.placements[1].group, 1u);
  EXPECT_EQ(groups.placements[1].instance, 2u);
}

TEST(MeshGroups, MeshesPlacedOftenStayAlone) {
  const MeshGroups groups = groupMeshes(placed(2, {{0, at(0), {}}, {1, at(0), {}}, {0, at(0), {}}}));
  ASSERT_EQ(groups.groups.size(), 2u);
  EXPECT_EQ(groups.placements.size(), 3u);
}

TEST(MeshGroups, UnusedMeshesAreInNone) {
  const MeshGroups groups = groupMeshes(placed(3, {{2, at(0), {}}}));
  ASSERT_EQ(groups.groups.size(), 1u);
  EXPECT_EQ(groups.groups[0].meshes, (std::vector<uint32_t>{2}));
}
