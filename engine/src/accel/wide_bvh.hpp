// Eight-wide hierarchies with quantized boxes, made from binary ones.
#pragma once

#include <cstdint>
#include <vector>

#include "accel/bvh.hpp"
#include "shared/geometry_types.h"

namespace isophote {

/// Nodes with indices relative to this tree: the root is node 0, leaf items index `order`. Never empty.
struct WideBvh {
  std::vector<gpu::BvhNode> nodes; ///< a node's inner children follow one another
  std::vector<uint32_t> order;     ///< item numbers; those of a node's leaves follow one another
  uint32_t maxDepth = 0;           ///< nodes from the root to the deepest leaf, at most that of the binary tree
  double sahCost = 0;              ///< expected node steps + item tests for a random ray that hits the root box
  Box bounds;
};

struct WideBvhOptions {
  float nodeCost = 1;
  float itemCost = 1;
  uint32_t maxLeafItems = 3; ///< 1 to 3
  uint32_t threads = 0;      ///< 0: all cores; the result does not depend on it
};

/// The cheapest tree of wide nodes that keeps the subtrees of `binary` whole.
///
/// Source: Ylitie, Karras, Laine 2017, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs",
/// sections 3.1 and 3.3.
/// @param binary  leaves of at most options.maxLeafItems items; of one each, the wide leaves are the best ones
[[nodiscard]] WideBvh widenBvh(const Bvh& binary, const WideBvhOptions& options = {});

/// The box of a child as a ray meets it; it holds the one that was stored. Empty where the slot is.
[[nodiscard]] Box childBox(const gpu::BvhNode& node, uint32_t slot);

} // namespace isophote
