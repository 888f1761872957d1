// Bounding volume hierarchies over axis-aligned boxes: a pure function of the boxes, deterministic.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "accel/unset_vector.hpp"
#include "shared/geometry_types.h"

namespace isophote {

struct Box {
  glm::vec3 lower{3.402823466e38f};
  glm::vec3 upper{-3.402823466e38f};
  void grow(glm::vec3 point) {
    lower = glm::min(lower, point);
    upper = glm::max(upper, point);
  }
  void grow(const Box& other) {
    lower = glm::min(lower, other.lower);
    upper = glm::max(upper, other.upper);
  }
};

/// Half the surface area, in double so that no finite box overflows; 0 for an empty box.
[[nodiscard]] inline double halfArea(const Box& box) {
  if (box.lower.x > box.upper.x) return 0;
  const glm::dvec3 extent = glm::dvec3(box.upper) - glm::dvec3(box.lower);
  return extent.x * extent.y + extent.y * extent.z + extent.z * extent.x;
}

/// Both children's boxes in the parent. count 0: child is an inner node's index; else child is the first of `count`
/// leaf items. An absent child has lower > upper.
struct BinaryNode {
  glm::vec3 lower0;
  uint32_t child0;
  glm::vec3 upper0;
  uint32_t count0;
  glm::vec3 lower1;
  uint32_t child1;
  glm::vec3 upper1;
  uint32_t count1;
};

/// Nodes with indices relative to this BVH (root 0, leaf items index `order`), otherwise in any order. Never empty: no
/// boxes give one node with two absent children; one leaf gives a node whose second child is absent.
struct Bvh {
  UnsetVector<BinaryNode> nodes; ///< the root first
  std::vector<uint32_t> order;   ///< item numbers; those of a leaf follow one another
  uint32_t maxDepth = 0;         ///< inner nodes from root to the deepest leaf, <= that of the options
  Box bounds;
};

struct BvhBuildOptions {
  uint32_t maxLeafItems = 3;
  float nodeCost = 1;
  float itemCost = 1;
  uint32_t maxDepth = gpu::kMaxBvhDepth; ///< of inner nodes; maxLeafItems * 2^maxDepth boxes must be no fewer
  uint32_t threads = 0;                  ///< 0: all cores; the result does not depend on it
};

/// Builds by binned surface-area heuristic (Wald 2007), falling back to object medians near the depth limit.
/// Boxes must be finite. Parents come before their children. Equal input gives equal output on any number of threads.
[[nodiscard]] Bvh buildBvh(std::span<const Box> boxes, const BvhBuildOptions& options = {});

} // namespace isophote
