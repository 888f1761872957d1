#include "accel/bvh.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "accel/fast_bvh.hpp"
#include "bvh_checks.hpp"

using namespace isophote;
using test::checkTree;
using test::expectedCost;
using test::randomBoxes;
using test::sameTree;

namespace {

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

struct Builder {
  const char* name;
  Bvh (*build)(const std::vector<Box>& boxes, uint32_t threads);
  friend void PrintTo(const Builder& builder, std::ostream* out) { *out << builder.name; }
};

const Builder kGood{
    "Good", [](const std::vector<Box>& boxes, uint32_t threads) { return buildBvh(boxes, {.threads = threads}); }};
const Builder kFast{"Fast",
                    [](const std::vector<Box>& boxes, uint32_t threads) { return buildFastBvh(boxes, threads); }};

class AnyBvh : public testing::TestWithParam<Builder> {
protected:
  static Bvh build(const std::vector<Box>& boxes, uint32_t threads = 0) { return GetParam().build(boxes, threads); }
};

INSTANTIATE_TEST_SUITE_P(Bvh, AnyBvh, testing::Values(kGood, kFast),
                         [](const auto& test) { return std::string(test.param.name); });

} // namespace

TEST_P(AnyBvh, NoBoxesGiveOneNodeWithTwoAbsentChildren) {
  const Bvh bvh = build({});
  ASSERT_EQ(bvh.nodes.size(), 1u);
  EXPECT_GT(bvh.nodes[0].lower0.x, bvh.nodes[0].upper0.x);
  EXPECT_GT(bvh.nodes[0].lower1.x, bvh.nodes[0].upper1.x);
  EXPECT_TRUE(bvh.order.empty());
}

TEST_P(AnyBvh, OneBoxGivesALeafBesideAnAbsentChild) {
  const std::vector<Box> boxes = randomBoxes(1, 1, 1);
  const Bvh bvh = build(boxes);
  ASSERT_EQ(bvh.nodes.size(), 1u);
  EXPECT_EQ(bvh.nodes[0].count0, 1u);
  EXPECT_GT(bvh.nodes[0].lower1.x, bvh.nodes[0].upper1.x);
  checkTree(boxes, bvh);
}

// Around 1,024, the fast builder's chunk, and its multiples too.
TEST_P(AnyBvh, HoldsEveryItemOnceInsideItsBoxes) {
  for (const uint32_t count : {2u,    3u,    4u,    5u,    6u,    7u,    8u,    9u,    31u,   100u,
                               1000u, 1023u, 1024u, 1025u, 1026u, 1060u, 2047u, 2048u, 2049u, 50000u}) {
    const std::vector<Box> boxes = randomBoxes(count, count, 0.3f);
    checkTree(boxes, build(boxes));
  }
}

TEST(Bvh, LeafSizeOptionIsObeyed) {
  const std::vector<Box> boxes = randomBoxes(5000, 9, 0.3f);
  for (const uint32_t size : {1u, 2u, 7u}) checkTree(boxes, buildBvh(boxes, {.maxLeafItems = size}), size);
}

TEST(Bvh, DepthOptionIsObeyed) {
  std::vector<Box> boxes(1000); // each holds half of what remains, so that the area heuristic alone goes deeper
  for (size_t i = 0; i < boxes.size(); ++i) {
    const float x = std::ldexp(1.0f, static_cast<int>(i / 8) - 62);
    boxes[i] = {glm::vec3(x, 0, 0), glm::vec3(1.5f * x, x, x)};
  }
  for (const uint32_t depth : {9u, 12u, 20u}) {
    EXPECT_LE(checkTree(boxes, buildBvh(boxes, {.maxDepth = depth})), depth);
  }
}

TEST_P(AnyBvh, IdenticalBoxesStayWithinTheDepthLimit) {
  const std::vector<Box> boxes(100000, Box{glm::vec3(1), glm::vec3(2)});
  EXPECT_LE(checkTree(boxes, build(boxes)), 18u); // halved from 1e5 to at most 3, or to chunks and within them
}

TEST_P(AnyBvh, PointsOnOneSpotStayWithinTheDepthLimit) {
  const std::vector<Box> boxes(3000, Box{glm::vec3(-3), glm::vec3(-3)});
  checkTree(boxes, build(boxes));
}

TEST_P(AnyBvh, GeometricProgressionsStayWithinTheDepthLimit) {
  // Each box holds half of what remains: the area heuristic peels off one at a time, and each box is nearest to the
  // one before it.
  for (const int copies : {1, 8, 40}) {
    std::vector<Box> boxes;
    for (int i = -120; i < 120; ++i) {
      const float x = std::ldexp(1.0f, i);
      for (int k = 0; k < copies; ++k) boxes.push_back({glm::vec3(x, 0, 0), glm::vec3(1.5f * x, x, x)});
    }
    checkTree(boxes, build(boxes));
  }
}

// Chains, in each of which only the smallest two boxes are nearest to each other, themselves in a progression: deep
// clusters below deep levels.
TEST_P(AnyBvh, ProgressionsOfProgressionsStayWithinTheDepthLimit) {
  std::vector<Box> boxes;
  for (int i = -110; i < 110; ++i) {
    for (int k = 0; k < 14; ++k) {
      const float place = std::ldexp(1.0f, i);
      const float size = std::ldexp(place, k - 15);
      boxes.push_back({glm::vec3(place), glm::vec3(place + size)});
    }
  }
  checkTree(boxes, build(boxes));
}

TEST(Bvh, GeometricProgressionsOfSingleItemsStayWithinTheDepthLimit) {
  std::vector<Box> boxes;
  for (int i = -960; i < 960; ++i) {
    const float x = std::ldexp(1.0f, i / 8);
    boxes.push_back({glm::vec3(x, 0, 0), glm::vec3(1.5f * x, x, x)});
  }
  checkTree(boxes, buildBvh(boxes, {.maxLeafItems = 1}), 1);
}

TEST_P(AnyBvh, AMillionPointsInALineStayWithinTheDepthLimit) {
  std::vector<Box> boxes(1000000);
  for (uint32_t i = 0; i < boxes.size(); ++i) boxes[i].grow(glm::vec3(static_cast<float>(i), 0, 0));
  checkTree(boxes, build(boxes));
}

TEST_P(AnyBvh, BoxesOfAnyFiniteSizeAreHandled) {
  for (const uint32_t count : {100u, 3000u}) {
    std::vector<Box> boxes = randomBoxes(count, 4, 1);
    boxes.push_back({glm::vec3(-3e38f), glm::vec3(3e38f)});
    boxes.push_back({glm::vec3(1e-40f), glm::vec3(2e-40f)});
    boxes.push_back({glm::vec3(-0.0f), glm::vec3(0.0f)});
    const Bvh bvh = build(boxes);
    checkTree(boxes, bvh);
    EXPECT_TRUE(std::isfinite(expectedCost(bvh)));
  }
}

TEST_P(AnyBvh, DoesNotDependOnTheNumberOfThreads) {
  const std::vector<Box> boxes = randomBoxes(200000, 7, 0.05f);
  const Bvh one = build(boxes, 1);
  for (const uint32_t threads : {0u, 2u, 3u, 8u}) EXPECT_TRUE(sameTree(one, build(boxes, threads))) << threads;
}

TEST(Bvh, CostsLessThanMedianSplits) {
  std::vector<Box> boxes = randomBoxes(20000, 3, 0.02f);
  const std::vector<Box> cluster = randomBoxes(20000, 5, 0.02f);
  for (const Box& box : cluster) boxes.push_back({0.01f * box.lower, 0.01f * box.upper});
  boxes.push_back({glm::vec3(-10), glm::vec3(10, -9.99f, 10)});
  const Bvh bvh = buildBvh(boxes);
  std::vector<Box> copy = boxes;
  EXPECT_LT(expectedCost(bvh), 0.8 * medianSplitCost(copy, 0, copy.size(), halfArea(bvh.bounds)));
}

// Of any size: areas are compared as scaled floats.
TEST(Bvh, FastTreesCostLittleMoreThanGoodOnes) {
  for (const float scale : {1.0f, 1e-30f, 1e18f, 1e36f}) {
    std::vector<Box> boxes = randomBoxes(20000, 3, 0.02f);
    const std::vector<Box> cluster = randomBoxes(20000, 5, 0.02f);
    for (const Box& box : cluster) boxes.push_back({0.01f * box.lower, 0.01f * box.upper});
    for (Box& box : boxes) box = {scale * box.lower, scale * box.upper};
    const double ratio = expectedCost(buildFastBvh(boxes)) / expectedCost(buildBvh(boxes, {.maxLeafItems = 1}));
    EXPECT_LT(ratio, 1.1) << scale;
    RecordProperty("ratio", std::to_string(ratio));
  }
}
