#include "accel/bvh.hpp"

#include <cstring>
#include <functional>
#include <random>

#include <gtest/gtest.h>

using namespace isophote;

namespace {

std::vector<Box> randomBoxes(uint32_t count, uint32_t seed, float size) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> position(-10, 10);
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

// Walks the tree from its root and fails on any broken promise of the header. Returns the depth found.
uint32_t checkTree(const std::vector<Box>& boxes, const Bvh& bvh, uint32_t maxLeafItems = 3) {
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

// Cost of the tree that always halves the items along the widest axis of their centers.
double medianSplitCost(std::vector<Box>& boxes, size_t first, size_t count, double rootArea) {
  Box bounds, centers;
  for (size_t i = first; i < first + count; ++i) {
    bounds.grow(boxes[i]);
    centers.grow(0.5f * (boxes[i].lower + boxes[i].upper));
  }
  if (count <= 3) return halfArea(bounds) / rootArea * static_cast<double>(count);
  const glm::vec3 e = centers.upper - centers.lower;
  const int axis = e.x >= e.y && e.x >= e.z ? 0 : e.y >= e.z ? 1 : 2;
  const auto begin = boxes.begin() + static_cast<ptrdiff_t>(first);
  std::nth_element(
      begin, begin + static_cast<ptrdiff_t>(count / 2), begin + static_cast<ptrdiff_t>(count),
      [axis](const Box& a, const Box& b) { return a.lower[axis] + a.upper[axis] < b.lower[axis] + b.upper[axis]; });
  return halfArea(bounds) / rootArea + medianSplitCost(boxes, first, count / 2, rootArea) +
         medianSplitCost(boxes, first + count / 2, count - count / 2, rootArea);
}

bool sameTree(const Bvh& a, const Bvh& b) {
  return a.order == b.order && a.nodes.size() == b.nodes.size() &&
         std::memcmp(a.nodes.data(), b.nodes.data(), a.nodes.size() * sizeof(BinaryNode)) == 0 &&
         a.sahCost == b.sahCost && a.maxDepth == b.maxDepth;
}

} // namespace

TEST(Bvh, NoBoxesGiveOneNodeWithTwoAbsentChildren) {
  const Bvh bvh = buildBvh({});
  ASSERT_EQ(bvh.nodes.size(), 1u);
  EXPECT_GT(bvh.nodes[0].lower0.x, bvh.nodes[0].upper0.x);
  EXPECT_GT(bvh.nodes[0].lower1.x, bvh.nodes[0].upper1.x);
  EXPECT_TRUE(bvh.order.empty());
}

TEST(Bvh, OneBoxGivesALeafBesideAnAbsentChild) {
  const std::vector<Box> boxes = randomBoxes(1, 1, 1);
  const Bvh bvh = buildBvh(boxes);
  ASSERT_EQ(bvh.nodes.size(), 1u);
  EXPECT_EQ(bvh.nodes[0].count0, 1u);
  EXPECT_GT(bvh.nodes[0].lower1.x, bvh.nodes[0].upper1.x);
  checkTree(boxes, bvh);
}

TEST(Bvh, HoldsEveryItemOnceInsideItsBoxes) {
  for (const uint32_t count : {2u, 3u, 4u, 5u, 6u, 7u, 8u, 9u, 31u, 100u, 1000u, 50000u}) {
    const std::vector<Box> boxes = randomBoxes(count, count, 0.3f);
    checkTree(boxes, buildBvh(boxes));
  }
}

TEST(Bvh, LeafSizeOptionIsObeyed) {
  const std::vector<Box> boxes = randomBoxes(5000, 9, 0.3f);
  for (const uint32_t size : {1u, 2u, 7u}) checkTree(boxes, buildBvh(boxes, {.maxLeafItems = size}), size);
}

TEST(Bvh, IdenticalBoxesStayWithinTheDepthLimit) {
  const std::vector<Box> boxes(100000, Box{glm::vec3(1), glm::vec3(2)});
  EXPECT_LE(checkTree(boxes, buildBvh(boxes)), 16u); // halved from 1e5 to 4
}

TEST(Bvh, PointsOnOneSpotStayWithinTheDepthLimit) {
  const std::vector<Box> boxes(1000, Box{glm::vec3(-3), glm::vec3(-3)});
  checkTree(boxes, buildBvh(boxes));
}

TEST(Bvh, GeometricProgressionsStayWithinTheDepthLimit) {
  // Each box holds half of what remains: the area heuristic peels off one at a time.
  std::vector<Box> boxes;
  for (int i = -120; i < 120; ++i) {
    const float x = std::ldexp(1.0f, i);
    for (int k = 0; k < 8; ++k) boxes.push_back({glm::vec3(x, 0, 0), glm::vec3(1.5f * x, x, x)});
  }
  checkTree(boxes, buildBvh(boxes));
  checkTree(boxes, buildBvh(boxes, {.maxLeafItems = 1}), 1);
}

TEST(Bvh, AMillionPointsInALineStayWithinTheDepthLimit) {
  std::vector<Box> boxes(1000000);
  for (uint32_t i = 0; i < boxes.size(); ++i) boxes[i].grow(glm::vec3(static_cast<float>(i), 0, 0));
  checkTree(boxes, buildBvh(boxes));
}

TEST(Bvh, BoxesOfAnyFiniteSizeAreHandled) {
  std::vector<Box> boxes = randomBoxes(100, 4, 1);
  boxes.push_back({glm::vec3(-3e38f), glm::vec3(3e38f)});
  boxes.push_back({glm::vec3(1e-40f), glm::vec3(2e-40f)});
  boxes.push_back({glm::vec3(-0.0f), glm::vec3(0.0f)});
  const Bvh bvh = buildBvh(boxes);
  checkTree(boxes, bvh);
  EXPECT_TRUE(std::isfinite(bvh.sahCost));
}

TEST(Bvh, DoesNotDependOnTheNumberOfThreads) {
  const std::vector<Box> boxes = randomBoxes(200000, 7, 0.05f);
  const Bvh one = buildBvh(boxes, {.threads = 1});
  for (const uint32_t threads : {2u, 3u, 8u})
    EXPECT_TRUE(sameTree(one, buildBvh(boxes, {.threads = threads}))) << threads;
  EXPECT_TRUE(sameTree(one, buildBvh(boxes)));
}

TEST(Bvh, CostIsTheSumOfVisitedAreas) {
  // Two unit cubes 9 apart: root half area 10*1 + 1*1 + 1*10 = 21, each leaf 3.
  const std::vector<Box> boxes{{glm::vec3(0), glm::vec3(1)}, {glm::vec3(9, 0, 0), glm::vec3(10, 1, 1)}};
  EXPECT_DOUBLE_EQ(buildBvh(boxes).sahCost, 1 + 2 * 3.0 / 21.0);
}

TEST(Bvh, CostsLessThanMedianSplits) {
  std::vector<Box> boxes = randomBoxes(20000, 3, 0.02f);
  const std::vector<Box> cluster = randomBoxes(20000, 5, 0.02f);
  for (const Box& box : cluster) boxes.push_back({0.01f * box.lower, 0.01f * box.upper});
  boxes.push_back({glm::vec3(-10), glm::vec3(10, -9.99f, 10)});
  const Bvh bvh = buildBvh(boxes);
  std::vector<Box> copy = boxes;
  EXPECT_LT(bvh.sahCost, 0.8 * medianSplitCost(copy, 0, copy.size(), halfArea(bvh.bounds)));
}
