#include "accel/wide_bvh.hpp"

#include <bit>
#include <cmath>
#include <cstring>
#include <functional>

#include <gtest/gtest.h>

#include "accel/fast_bvh.hpp"
#include "bvh_checks.hpp"

using namespace isophote;
using gpu::BvhNode;
using test::contains;
using test::randomBoxes;

namespace {

uint32_t itemsOf(const BvhNode& node, uint32_t slot) {
  return std::popcount(node.contents >> gpu::kBvhItemsPerSlot * slot & ((1u << gpu::kBvhItemsPerSlot) - 1));
}

bool isInner(const BvhNode& node, uint32_t slot) { return (node.contents >> (gpu::kBvhInnerShift + slot) & 1u) != 0; }

// Every item is in one leaf, and all boxes on the way to it hold its own. Returns the depth.
uint32_t checkTree(const std::vector<Box>& boxes, const WideBvh& bvh, uint32_t maxLeafItems = 3) {
  std::vector<uint32_t> seen(boxes.size()), nodeSeen(bvh.nodes.size());
  std::vector<Box> path;
  const std::function<uint32_t(uint32_t)> visit = [&](uint32_t index) -> uint32_t {
    ++nodeSeen.at(index);
    const BvhNode& node = bvh.nodes.at(index);
    uint32_t depth = 0, child = node.firstChild, item = node.firstItem;
    for (uint32_t slot = 0; slot < gpu::kBvhWidth; ++slot) {
      const uint32_t items = itemsOf(node, slot);
      path.push_back(childBox(node, slot));
      if (isInner(node, slot)) {
        EXPECT_EQ(items, 0u);
        depth = std::max(depth, visit(child++));
      }
      EXPECT_LE(items, maxLeafItems);
      for (uint32_t i = 0; i < items; ++i) {
        const uint32_t number = bvh.order.at(item++);
        ++seen.at(number);
        for (const Box& box : path) EXPECT_TRUE(contains(box, boxes[number]));
      }
      path.pop_back();
    }
    return depth + 1;
  };
  const uint32_t depth = visit(0);
  EXPECT_EQ(depth, bvh.maxDepth);
  EXPECT_EQ(bvh.order.size(), boxes.size());
  EXPECT_EQ(std::count(seen.begin(), seen.end(), 1u), static_cast<ptrdiff_t>(boxes.size()));
  EXPECT_EQ(std::count(nodeSeen.begin(), nodeSeen.end(), 1u), static_cast<ptrdiff_t>(bvh.nodes.size()));
  return depth;
}

} // namespace

TEST(WideBvh, NoBoxesGiveOneEmptyNode) {
  const WideBvh bvh = widenBvh(buildBvh({}));
  ASSERT_EQ(bvh.nodes.size(), 1u);
  EXPECT_EQ(bvh.nodes[0].contents, 0u);
}

TEST(WideBvh, HoldsEveryItemOnceInsideItsBoxes) {
  for (const uint32_t count : {1u, 2u, 3u, 4u, 5u, 8u, 9u, 24u, 25u, 100u, 1000u, 20000u}) {
    const std::vector<Box> boxes = randomBoxes(count, count, 0.3f);
    const Bvh binary = buildBvh(boxes);
    EXPECT_LE(checkTree(boxes, widenBvh(binary)), binary.maxDepth);
    const Bvh fast = buildFastBvh(boxes);
    EXPECT_LE(checkTree(boxes, widenBvh(fast)), fast.maxDepth);
  }
}

TEST(WideBvh, LeafSizeOptionIsObeyed) {
  const std::vector<Box> boxes = randomBoxes(3000, 9, 0.3f);
  for (const uint32_t size : {1u, 2u, 3u}) {
    checkTree(boxes, widenBvh(buildBvh(boxes, {.maxLeafItems = size}), {.maxLeafItems = size}), size);
  }
}

TEST(WideBvh, BoxesAreHeldAtAnySizeAndPlace) {
  // Flat, tiny, huge and far away: a cell of a frame is a power of two, and its origin a float.
  std::vector<Box> boxes = randomBoxes(200, 4, 1);
  for (const float size : {1e-30f, 1e-6f, 1e3f, 1e15f}) {
    for (const Box& box : randomBoxes(60, 5, size, size)) boxes.push_back(box);
    for (const Box& box : randomBoxes(60, 6, 1e-3f * size)) boxes.push_back({1e4f + box.lower, 1e4f + box.upper});
  }
  for (int i = 0; i < 50; ++i) boxes.push_back({glm::vec3(i, 2, -3), glm::vec3(i + 1, 2, -3)});
  checkTree(boxes, widenBvh(buildBvh(boxes)));
}

// Half areas of up to 1e72, which no float holds.
TEST(WideBvh, AreasMayBeLargerThanFloats) {
  for (const float scale : {1e19f, 1e30f, 1e36f}) {
    std::vector<Box> boxes = randomBoxes(200, 4, 1);
    for (Box& box : boxes) {
      box.lower *= scale;
      box.upper *= scale;
    }
    const WideBvh bvh = widenBvh(buildBvh(boxes));
    checkTree(boxes, bvh);
    EXPECT_LT(bvh.nodes.size(), 60u) << "as good a tree as that of small boxes";
  }
}

TEST(WideBvh, FramesAreAtMostTwiceAndABitAsWideAsTheirNode) {
  const std::vector<Box> boxes = randomBoxes(5000, 7, 0.1f);
  const WideBvh bvh = widenBvh(buildBvh(boxes));
  for (const BvhNode& node : bvh.nodes) {
    Box all;
    for (uint32_t slot = 0; slot < gpu::kBvhWidth; ++slot) all.grow(childBox(node, slot));
    for (int axis = 0; axis < 3; ++axis) {
      const double size = std::ldexp(1.0, static_cast<int>(node.exponents >> 8 * axis & 0xffu) - 127);
      EXPECT_LE(size, 2.03 * (static_cast<double>(all.upper[axis]) - all.lower[axis])) << axis;
    }
  }
}

TEST(WideBvh, CostIsTheSumOfVisitedAreas) {
  // Two unit cubes 9 apart: root half area 10*1 + 1*1 + 1*10 = 21, each leaf 3.
  const std::vector<Box> boxes{{glm::vec3(0), glm::vec3(1)}, {glm::vec3(9, 0, 0), glm::vec3(10, 1, 1)}};
  EXPECT_DOUBLE_EQ(widenBvh(buildBvh(boxes, {.maxLeafItems = 1})).sahCost, 1 + 2 * 3.0 / 21.0);
}

TEST(WideBvh, CostsLessThanTheBinaryTreeAndFillsItsNodes) {
  const std::vector<Box> boxes = randomBoxes(20000, 3, 0.05f);
  const Bvh binary = buildBvh(boxes, {.itemCost = 0.4f});
  const WideBvh wide = widenBvh(binary);
  EXPECT_LT(wide.sahCost, 0.6 * test::expectedCost(binary));
  uint64_t children = 0;
  for (const BvhNode& node : wide.nodes) {
    for (uint32_t slot = 0; slot < gpu::kBvhWidth; ++slot) children += isInner(node, slot) || itemsOf(node, slot) > 0;
  }
  EXPECT_GT(static_cast<double>(children) / static_cast<double>(wide.nodes.size()), 4.5);
}

TEST(WideBvh, SlotsGoByPlace) {
  // Eight boxes in the corners of a cube: each gets the slot of its corner.
  std::vector<Box> boxes;
  for (uint32_t slot = 0; slot < 8; ++slot) {
    const glm::vec3 corner(slot & 1u, slot >> 1 & 1u, slot >> 2);
    boxes.push_back({3.0f * corner, 3.0f * corner + 1.0f});
  }
  const WideBvh bvh = widenBvh(buildBvh(boxes, {.maxLeafItems = 1}), {.maxLeafItems = 1});
  ASSERT_EQ(bvh.nodes.size(), 1u);
  EXPECT_EQ(bvh.order, (std::vector<uint32_t>{0, 1, 2, 3, 4, 5, 6, 7}));
}

TEST(WideBvh, DoesNotDependOnTheNumberOfThreads) {
  const std::vector<Box> boxes = randomBoxes(200000, 21, 0.05f);
  for (const Bvh& binary : {buildBvh(boxes, {.maxLeafItems = 1}), buildFastBvh(boxes)}) {
    const WideBvh alone = widenBvh(binary, {.threads = 1});
    const WideBvh shared = widenBvh(binary, {.threads = 3});
    ASSERT_EQ(alone.nodes.size(), shared.nodes.size());
    EXPECT_EQ(std::memcmp(alone.nodes.data(), shared.nodes.data(), alone.nodes.size() * sizeof(BvhNode)), 0);
    EXPECT_EQ(alone.order, shared.order);
    EXPECT_EQ(alone.maxDepth, shared.maxDepth);
    EXPECT_EQ(alone.sahCost, shared.sahCost);
  }
}
