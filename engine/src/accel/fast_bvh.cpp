#include "accel/fast_bvh.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "accel/parallel_for.hpp"
#include "accel/z_order.hpp"

namespace isophote {
namespace {

using gpu::kMaxBvhDepth;

// Boxes that one thread makes into clusters at a time: what it needs fits the second cache.
constexpr uint32_t kChunk = 1024;

// Neighbors on each side among which a cluster finds its nearest one. Eight of them make no better tree. At most 15,
// so that nearestOf can tell them apart.
constexpr uint32_t kRadius = 3;

// Clusters are made until there are so many times fewer than boxes. Sixteen make no better tree.
constexpr uint32_t kBoxesPerCluster = 32;

// Inner nodes on top of each other within a cluster; the others are for the levels above.
constexpr uint32_t kMaxClusterDepth = 8;
constexpr uint32_t kMaxTopDepth = kMaxBvhDepth - kMaxClusterDepth;

// The round that merges less than a sixteenth of the clusters is the last: of boxes that grow along the curve each is
// nearest to the one before, and rounds would be as many as clusters.
constexpr uint32_t kLeastShareOfPairs = 16;

// A part of the tree: a node or, where items is 1, an item by its place in Z-order.
struct Cluster {
  Box box;
  uint32_t root;
  uint32_t items;
  uint32_t depth; // inner nodes down to the deepest leaf
};

BinaryNode nodeOf(const Cluster& left, const Cluster& right) {
  const auto leafItems = [](const Cluster& cluster) { return cluster.items == 1 ? 1u : 0u; };
  return {left.box.lower,  left.root,  left.box.upper,  leafItems(left),
          right.box.lower, right.root, right.box.upper, leafItems(right)};
}

// The clusters of one chunk while they are made, with their boxes by coordinate, scaled so that areas fit floats.
class Agglomeration {
public:
  // @param order  items of the chunk, the first of which has place `first` in Z-order
  Agglomeration(std::span<const Box> boxes, std::span<const uint32_t> order, uint32_t first, float scale)
      : scale_(scale), count_(static_cast<uint32_t>(order.size())) {
    for (uint32_t i = 0; i < count_; ++i) set(i, {boxes[order[i]], first + i, 1, 0});
  }

  // Puts the nodes of each cluster in a row, parents first, and all of them before `end` of the tree's.
  // @return clusters whose roots are such nodes
  std::span<const Cluster> run(UnsetVector<BinaryNode>& nodes, uint32_t end) {
    const uint32_t enough = std::max(1u, count_ / kBoxesPerCluster);
    while (count_ > enough) {
      findNearest();
      const uint32_t before = count_;
      mergePairs();
      if ((before - count_) * kLeastShareOfPairs < before) break;
    }
    uint32_t next = end - nodeCount_;
    for (uint32_t i = 0; i < count_; ++i) {
      if (clusters_[i].items > 1) clusters_[i].root = copySubtree(clusters_[i].root, nodes, next);
    }
    return {clusters_.data(), count_};
  }

private:
  void set(uint32_t i, const Cluster& cluster) {
    clusters_[i] = cluster;
    for (int axis = 0; axis < 3; ++axis) {
      lower_[axis][i] = cluster.box.lower[axis] * scale_;
      upper_[axis][i] = cluster.box.upper[axis] * scale_;
    }
  }

  // A pair's distance is the area of its common box: as a float's bits, the last five of which are instead those in
  // which the two numbers differ. So a cluster's distances are all different, and equally near pairs are disjoint.
  static constexpr int32_t kNumberBits = 31;

  void findNearest() {
    std::fill_n(nearest_.begin(), count_, std::numeric_limits<int32_t>::max());
    for (uint32_t offset = 1; offset <= std::min(kRadius, count_ - 1); ++offset) {
      const uint32_t pairs = count_ - offset;
      findDistances(pairs, offset);
      for (uint32_t i = 0; i < pairs; ++i) nearest_[i] = distance_[i] < nearest_[i] ? distance_[i] : nearest_[i];
      int32_t* const others = nearest_.data() + offset;
      for (uint32_t i = 0; i < pairs; ++i) others[i] = distance_[i] < others[i] ? distance_[i] : others[i];
    }
  }

  void findDistances(uint32_t pairs, uint32_t offset) {
    const auto extent = [&](int axis, uint32_t i) {
      const float* const lower = lower_[axis].data();
      const float* const upper = upper_[axis].data();
      const float from = lower[i] < lower[i + offset] ? lower[i] : lower[i + offset];
      const float to = upper[i] > upper[i + offset] ? upper[i] : upper[i + offset];
      return to - from;
    };
    for (uint32_t i = 0; i < pairs; ++i) {
      const float x = extent(0, i);
      const float y = extent(1, i);
      const float z = extent(2, i);
      const auto bits = std::bit_cast<int32_t>(x * y + y * z + z * x);
      distance_[i] = (bits & ~kNumberBits) | (static_cast<int32_t>(i ^ (i + offset)) & kNumberBits);
    }
  }

  [[nodiscard]] uint32_t nearestOf(uint32_t i) const {
    const uint32_t lowBits = (i ^ static_cast<uint32_t>(nearest_[i])) & kNumberBits;
    const uint32_t ahead = (lowBits - i) & kNumberBits; // modulo 32
    return ahead <= kRadius ? i + ahead : i + ahead - (kNumberBits + 1);
  }

  // Each pair becomes a cluster in the place of the first of the two.
  void mergePairs() {
    for (uint32_t i = 0; i < count_; ++i) {
      const uint32_t other = nearestOf(i);
      const bool fits = std::max(clusters_[i].depth, clusters_[other].depth) < kMaxClusterDepth;
      partner_[i] = fits && nearestOf(other) == i ? other : i;
    }
    uint32_t kept = 0;
    for (uint32_t i = 0; i < count_; ++i) {
      if (partner_[i] == i) {
        if (kept != i) set(kept, clusters_[i]);
        ++kept;
      } else if (partner_[i] > i) {
        set(kept++, merged(clusters_[i], clusters_[partner_[i]]));
      }
    }
    count_ = kept;
  }

  Cluster merged(const Cluster& left, const Cluster& right) {
    nodes_[nodeCount_] = nodeOf(left, right);
    Cluster result{left.box, nodeCount_++, left.items + right.items, 1 + std::max(left.depth, right.depth)};
    result.box.grow(right.box);
    return result;
  }

  // Returns where its root is.
  uint32_t copySubtree(uint32_t root, UnsetVector<BinaryNode>& nodes, uint32_t& next) const {
    const uint32_t self = next++;
    BinaryNode node = nodes_[root];
    if (node.count0 == 0) node.child0 = copySubtree(node.child0, nodes, next);
    if (node.count1 == 0) node.child1 = copySubtree(node.child1, nodes, next);
    nodes[self] = node;
    return self;
  }

  float scale_;
  uint32_t count_;
  uint32_t nodeCount_ = 0;
  std::array<BinaryNode, kChunk> nodes_; // children first
  std::array<Cluster, kChunk> clusters_;
  std::array<std::array<float, kChunk>, 3> lower_, upper_;
  std::array<int32_t, kChunk> nearest_, distance_;
  std::array<uint32_t, kChunk> partner_;
};

// A power of two that brings the extent of a scene near 1, so that areas are neither zero nor infinite.
float scaleOf(const Box& all) {
  float largest = 0;
  for (int axis = 0; axis < 3; ++axis) largest = std::max(largest, 0.5f * all.upper[axis] - 0.5f * all.lower[axis]);
  if (largest == 0) return 1;
  return std::ldexp(1.0f, std::clamp(-std::ilogb(largest), -125, 125));
}

// What chunks leave for the levels above.
struct Clusters {
  std::vector<Cluster> clusters;
  std::vector<uint32_t> freeNodes; // ascending from 0, one fewer than clusters
};

// Makes each chunk's nodes the last of as many as it has items. It needs as many fewer as it has clusters; those are
// free for the levels above, which need all but one. The root is the first, as a full chunk leaves several clusters.
Clusters makeClusters(std::span<const Box> boxes, Bvh& bvh, uint32_t threads) {
  const auto count = static_cast<uint32_t>(boxes.size());
  const float scale = scaleOf(bvh.bounds);
  std::vector<std::vector<Cluster>> found((count + kChunk - 1) / kChunk);
  parallelFor(static_cast<uint32_t>(found.size()), threads, [&](uint32_t chunk) {
    const uint32_t first = chunk * kChunk;
    const uint32_t items = std::min(kChunk, count - first);
    Agglomeration agglomeration(boxes, std::span(bvh.order).subspan(first, items), first, scale);
    const std::span<const Cluster> clusters = agglomeration.run(bvh.nodes, first + items - 1);
    found[chunk].assign(clusters.begin(), clusters.end());
  });
  Clusters all;
  for (uint32_t chunk = 0; chunk < found.size(); ++chunk) {
    all.clusters.insert(all.clusters.end(), found[chunk].begin(), found[chunk].end());
    for (uint32_t i = 0; i < found[chunk].size(); ++i) {
      if (chunk != 0 || i != 0) all.freeNodes.push_back(chunk * kChunk + i - 1);
    }
  }
  return all;
}

// Puts the tree over the clusters into the free nodes.
void addTop(const Bvh& top, const Clusters& all, Bvh& bvh) {
  std::vector<uint32_t> depths(top.nodes.size(), 1);
  for (uint32_t i = 0; i < top.nodes.size(); ++i) { // parents first
    BinaryNode node = top.nodes[i];
    const auto setChild = [&](uint32_t& child, uint32_t& count) {
      if (count == 0) {
        depths[child] = depths[i] + 1;
        child = all.freeNodes[child];
        return;
      }
      const Cluster& cluster = all.clusters[top.order[child]];
      child = cluster.root;
      count = cluster.items == 1 ? 1 : 0;
      bvh.maxDepth = std::max(bvh.maxDepth, depths[i] + cluster.depth);
    };
    setChild(node.child0, node.count0);
    setChild(node.child1, node.count1);
    bvh.nodes[all.freeNodes[i]] = node;
  }
}

} // namespace

Bvh buildFastBvh(std::span<const Box> boxes, uint32_t threads) {
  BvhBuildOptions options{.maxLeafItems = 1, .threads = threads};
  if (boxes.size() <= kChunk) return buildBvh(boxes, options);
  threads = threadCount(threads);
  Bvh bvh;
  for (const Box& box : boxes) bvh.bounds.grow(box);
  bvh.order = zOrder(boxes, threads);
  bvh.nodes.resize(boxes.size() - 1);
  const Clusters all = makeClusters(boxes, bvh, threads);
  if (all.clusters.size() >> kMaxTopDepth != 0) return buildBvh(boxes, options);
  std::vector<Box> tops;
  for (const Cluster& cluster : all.clusters) tops.push_back(cluster.box);
  options.maxDepth = kMaxTopDepth;
  const Bvh top = buildBvh(tops, options);
  addTop(top, all, bvh);
  return bvh;
}

} // namespace isophote
