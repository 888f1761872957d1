#include "accel/z_order.hpp"

#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>

#include "bvh_checks.hpp"

using namespace isophote;
using test::randomBoxes;

namespace {

// Whether the cell of `a` comes before that of `b`: the axis in whose numbers the highest differing bit stands decides.
bool comesBefore(const glm::uvec3& a, const glm::uvec3& b) {
  int axis = 2;
  for (const int other : {1, 0}) {
    const uint32_t most = a[axis] ^ b[axis], bits = a[other] ^ b[other];
    if (most < bits && most < (most ^ bits)) axis = other;
  }
  return a[axis] < b[axis];
}

std::vector<uint32_t> sortedByCells(const std::vector<Box>& boxes) {
  Box all;
  for (const Box& box : boxes) all.grow(box);
  std::vector<glm::uvec3> cells;
  for (const Box& box : boxes) {
    const glm::dvec3 center = 0.5 * (glm::dvec3(box.lower) + glm::dvec3(box.upper)) - glm::dvec3(all.lower);
    const glm::dvec3 size = glm::dvec3(all.upper) - glm::dvec3(all.lower);
    cells.emplace_back(glm::min(center * (2097152.0 / size), glm::dvec3(2097151)));
  }
  std::vector<uint32_t> order(boxes.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return comesBefore(cells[a], cells[b]); });
  return order;
}

} // namespace

TEST(ZOrder, IsThatOfTheCells) {
  for (const uint32_t count : {1u, 2u, 3u, 100u, 70000u}) {
    const std::vector<Box> boxes = randomBoxes(count, count, 0.1f);
    EXPECT_EQ(zOrder(boxes), sortedByCells(boxes)) << count;
  }
  EXPECT_TRUE(zOrder({}).empty());
}

// A thousandth of the bounds holds nearly all, so that what is sorted at once does not tell most of them apart.
TEST(ZOrder, TellsApartWhatIsSmallBesideItsScene) {
  std::vector<Box> boxes = randomBoxes(50000, 6, 1e-6f, 1e-3f);
  for (const Box& box : randomBoxes(10, 7, 0.1f)) boxes.push_back(box);
  EXPECT_EQ(zOrder(boxes), sortedByCells(boxes));
}

TEST(ZOrder, KeepsTheOrderOfEqualBoxes) {
  std::vector<Box> boxes = randomBoxes(20, 8, 1);
  for (uint32_t i = 0; i < 40000; ++i) boxes.push_back(boxes[i % 20]);
  EXPECT_EQ(zOrder(boxes), sortedByCells(boxes));
}

TEST(ZOrder, DoesNotDependOnTheNumberOfThreads) {
  const std::vector<Box> boxes = randomBoxes(100000, 9, 0.1f);
  const std::vector<uint32_t> alone = zOrder(boxes, 1);
  for (const uint32_t threads : {2u, 3u, 8u}) EXPECT_EQ(zOrder(boxes, threads), alone) << threads;
}
