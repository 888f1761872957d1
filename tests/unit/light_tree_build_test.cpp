#include "accel/light_tree.hpp"

#include <cstring>
#include <random>

#include <gtest/gtest.h>

using namespace isophote;

TEST(LightTreeBuild, LargeTreesAreCompleteWhateverThreadsBuildThem) {
  // Halves of many lights are built by threads of their own: every node is written once, every light found.
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<LightBound> lights(30000);
  for (LightBound& light : lights) {
    light.lower = light.upper = {uniform(random), uniform(random), uniform(random)};
    light.intensity = light.power = 1.5 + uniform(random);
  }
  const LightTree tree = buildLightTree(lights);
  ASSERT_EQ(tree.nodes.size(), 2 * lights.size() - 1);
  for (uint32_t i = 0; i < lights.size(); ++i) {
    uint32_t node = 0;
    for (uint32_t trail = tree.trails[i]; !(tree.nodes[node].child & gpu::kLightTreeLeaf); trail >>= 1) {
      const uint32_t children = tree.nodes[node].child & ~gpu::kLightTreeTwoSided;
      ASSERT_LT(children + 1, tree.nodes.size());
      node = children + (trail & 1);
    }
    EXPECT_EQ(tree.nodes[node].child, i | gpu::kLightTreeLeaf);
  }
  EXPECT_EQ(std::memcmp(buildLightTree(lights).nodes.data(), tree.nodes.data(),
                        tree.nodes.size() * sizeof(gpu::LightTreeNode)),
            0);
}
