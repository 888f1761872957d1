#include "bvh_checks.hpp"

#include <algorithm>
#include <cstring>
#include <functional>
#include <random>

#include <gtest/gtest.h>

namespace isophote::test {

std::vector<Box> randomBoxes(uint32_t count, uint32_t seed, float size, float spread) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> position(-spread, spread);
  std::exponential_distribution<float> extent(1 / size);
  std::vector<Box> boxes(count);
  for (Box& box : boxes) {
    const glm::vec3 lower(position(random), position(random), position(random));
    box.grow(lower);
    box.grow(lower + glm::vec3(extent(random), extent(random), extent(random)));
  }
  return boxes;
}

bool contains(const Box& outer, const Box& inner) {
  return glm::all(glm::lessThanEqual(outer.lower, inner.lower)) &&
         glm::all(glm::greaterThanEqual(outer.upper, inner.upper));
}

uint32_t checkTree(const std::vector<Box>& boxes, const Bvh& bvh, uint32_t maxLeafItems) {
  std::vector<uint32_t> seen(boxes.size(), 0);
  std::vector<uint32_t> nodeSeen(bvh.nodes.size(), 0);
  uint32_t leafItems = 0;
  const std::function<uint32_t(uint32_t, const Box&)> visit = [&](uint32_t index, const Box& bounds) -> uint32_t {
    EXPECT_LT(index, bvh.nodes.size());
    EXPECT_EQ(++nodeSeen[index], 1u);
    const BinaryNode& node = bvh.nodes[index];
    uint32_t depth = 0;
    for (int side = 0; side < 2; ++side) {
      const Box box{side == 0 ? node.lower0 : node.lower1, side == 0 ? node.upper0 : node.upper1};
      const uint32_t child = side == 0 ? node.child0 : node.child1;
      const uint32_t count = side == 0 ? node.count0 : node.count1;
      if (box.lower.x > box.upper.x) continue;
      EXPECT_TRUE(contains(bounds, box));
      if (count == 0) {
        depth = std::max(depth, visit(child, box));
        continue;
      }
      EXPECT_LE(count, maxLeafItems);
      for (uint32_t i = child; i < child + count; ++i) {
        const uint32_t item = bvh.order.at(i);
        ++seen.at(item);
        ++leafItems;
        EXPECT_TRUE(contains(box, boxes[item]));
      }
    }
    return depth + 1;
  };
  const uint32_t depth = visit(0, bvh.bounds);
  EXPECT_EQ(bvh.order.size(), boxes.size());
  EXPECT_EQ(leafItems, boxes.size());
  EXPECT_EQ(std::count(seen.begin(), seen.end(), 1u), static_cast<ptrdiff_t>(boxes.size()));
  EXPECT_EQ(std::count(nodeSeen.begin(), nodeSeen.end(), 1u), static_cast<ptrdiff_t>(bvh.nodes.size()));
  EXPECT_EQ(depth, bvh.maxDepth);
  EXPECT_LE(depth, gpu::kMaxBvhDepth);
  return depth;
}

bool sameTree(const Bvh& a, const Bvh& b) {
  return a.order == b.order && a.nodes.size() == b.nodes.size() &&
         std::memcmp(a.nodes.data(), b.nodes.data(), a.nodes.size() * sizeof(BinaryNode)) == 0 &&
         a.maxDepth == b.maxDepth;
}

double expectedCost(const Bvh& bvh) {
  double sum = 0;
  for (const BinaryNode& node : bvh.nodes) {
    sum += halfArea({node.lower0, node.upper0}) * std::max(node.count0, 1u);
    sum += halfArea({node.lower1, node.upper1}) * std::max(node.count1, 1u);
  }
  return 1 + sum / halfArea(bvh.bounds);
}

} // namespace isophote::test
