// What tests of trees share: boxes, and whether a binary tree keeps the promises of accel/bvh.hpp.
#pragma once

#include <cstdint>
#include <vector>

#include "accel/bvh.hpp"

namespace isophote::test {

/// Corners alike in [-spread, spread]^3, extents of `size` in the mean.
[[nodiscard]] std::vector<Box> randomBoxes(uint32_t count, uint32_t seed, float size, float spread = 10);

[[nodiscard]] bool contains(const Box& outer, const Box& inner);

/// Walks the tree from its root and fails on any broken promise. Returns the depth found.
uint32_t checkTree(const std::vector<Box>& boxes, const Bvh& bvh, uint32_t maxLeafItems = 3);

[[nodiscard]] bool sameTree(const Bvh& a, const Bvh& b);

/// Expected node steps and item tests of a random ray that hits the bounds: a box inside is hit with the probability
/// that is the ratio of their areas (Goldsmith and Salmon 1987).
[[nodiscard]] double expectedCost(const Bvh& bvh);

} // namespace isophote::test
