#include "accel/fast_bvh.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <memory>
#include <numeric>
#include <utility>
#include <chrono>
#include <sys/resource.h>

#include "accel/parallel_for.hpp"
#include "accel/z_order.hpp"

namespace isophote {
namespace {

using gpu::kMaxBvhDepth;
struct TM{double c,w;static double cpu(){rusage u;getrusage(RUSAGE_SELF,&u);return u.ru_utime.tv_sec+u.ru_stime.tv_sec+1e-6*(u.ru_utime.tv_usec+u.ru_stime.tv_usec);}
static double wall(){return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();}
TM():c(cpu()),w(wall()){}
void operator()(const char*n){if(getenv("TM"))printf("   %s wall %.1f cpu %.1f ms\n",n,1e3*(wall()-w),1e3*(cpu()-c));c=cpu();w=wall();}};


// Boxes that one thread makes into clusters at a time: their arrays fit the first cache.
constexpr uint32_t kChunk = 1024;

// Neighbors on each side among which a cluster finds its nearest one; at most 15, so that nearestOf can tell them apart.
#ifndef RADIUS
#define RADIUS 8
#endif
#ifndef PER
#define PER 16
#endif
constexpr uint32_t kRadius = RADIUS;

// Clusters are made until there are so many times fewer than boxes.
constexpr uint32_t kBoxesPerCluster = PER;

// Inner nodes on top of each other within a cluster; the others are for the levels above.
constexpr uint32_t kMaxClusterDepth = 10;
constexpr uint32_t kMaxTopDepth = kMaxBvhDepth - kMaxClusterDepth;

// A round that makes fewer than a sixteenth of the clusters' number into pairs is the last: what is left is so uneven
// that rounds would grow as many as clusters.
constexpr uint32_t kLeastShareOfPairs = 16;

constexpr uint32_t kIsItem = 1u << 31;

// An inner node of a cluster. Children are nodes of the same chunk, or items by their place in Z-order with kIsItem set.
struct Node {
  Box box;
  uint32_t left, right;
};

struct Cluster {
  Box box;
  uint32_t root;  // as the children of a Node
  uint32_t items;
  uint32_t depth; // inner nodes down to the deepest leaf
};

// The clusters of one chunk while they are made, with their boxes by coordinate, scaled so that areas fit floats.
class Agglomeration {
public:
  // @param order  items of the chunk, the first of which has number `first` in Z-order
  // @param nodes  room for as many nodes as items, less one
  Agglomeration(std::span<const Box> boxes, std::span<const uint32_t> order, uint32_t first, float scale, Node* nodes)
      : scale_(scale), nodes_(nodes), firstNode_(first), count_(static_cast<uint32_t>(order.size())) {
    for (uint32_t i = 0; i < count_; ++i) set(i, {boxes[order[i]], (first + i) | kIsItem, 1, 0});
  }

  std::span<const Cluster> run() {
    const uint32_t enough = std::max(1u, count_ / kBoxesPerCluster);
    while (count_ > enough) {
      findNearest();
      const uint32_t before = count_;
      mergePairs();
      if ((before - count_) * kLeastShareOfPairs < before) break;
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
    Cluster result{left.box, firstNode_ + nodeCount_, left.items + right.items, 1 + std::max(left.depth, right.depth)};
    result.box.grow(right.box);
    nodes_[nodeCount_++] = {result.box, left.root, right.root};
    return result;
  }

  float scale_;
  Node* nodes_;
  uint32_t firstNode_;
  uint32_t nodeCount_ = 0;
  uint32_t count_;
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

// Puts clusters where the leaves of the tree above them are.
class Graft {
public:
  Graft(std::span<const Box> boxes, std::span<const uint32_t> order, const Node* nodes,
        std::span<const Cluster> clusters, const Bvh& top)
      : boxes_(boxes), order_(order), nodes_(nodes), clusters_(clusters), top_(top), places_(clusters.size()) {}

  Bvh run(uint32_t threads) {
    result_.bounds = top_.bounds;
    result_.nodes.resize(order_.size() - 1);
    result_.order.resize(order_.size());
    placeTop(0, 1);
    constexpr uint32_t kClustersPerTurn = 256;
    const auto count = static_cast<uint32_t>(clusters_.size());
    parallelFor((count + kClustersPerTurn - 1) / kClustersPerTurn, threads, [&](uint32_t turn) {
      const uint32_t last = std::min(count, (turn + 1) * kClustersPerTurn);
      for (uint32_t i = turn * kClustersPerTurn; i < last; ++i) {
        Place place = places_[i];
        if (clusters_[i].items == 1) {
          result_.order[place.item] = order_[clusters_[i].root & ~kIsItem];
        } else {
          placeNode(clusters_[i].root, place);
        }
      }
    });
    return std::move(result_);
  }

private:
  // Where the next node and the next item go.
  struct Place {
    uint32_t node, item;
  };

  // What a parent says of a child.
  struct Child {
    Box box;
    uint32_t index, count;
  };

  static BinaryNode nodeOf(const Child& left, const Child& right) {
    return {left.box.lower,  left.index,  left.box.upper,  left.count,
            right.box.lower, right.index, right.box.upper, right.count};
  }

  void placeTop(uint32_t number, uint32_t depth) {
    const BinaryNode& node = top_.nodes[number];
    const uint32_t self = next_.node++;
    const Child left = topChild({node.lower0, node.upper0}, node.child0, node.count0, depth);
    const Child right = topChild({node.lower1, node.upper1}, node.child1, node.count1, depth);
    result_.nodes[self] = nodeOf(left, right);
  }

  Child topChild(const Box& box, uint32_t child, uint32_t count, uint32_t depth) {
    const Place place = next_;
    if (count == 0) {
      placeTop(child, depth + 1);
      return {box, place.node, 0};
    }
    const uint32_t number = top_.order[child];
    const Cluster& cluster = clusters_[number];
    places_[number] = place;
    next_.node += cluster.items - 1;
    next_.item += cluster.items;
    result_.maxDepth = std::max(result_.maxDepth, depth + cluster.depth);
    return cluster.items == 1 ? Child{box, place.item, 1} : Child{box, place.node, 0};
  }

  void placeNode(uint32_t number, Place& next) {
    const Node& node = nodes_[number];
    const uint32_t self = next.node++;
    const Child left = child(node.left, next);
    const Child right = child(node.right, next);
    result_.nodes[self] = nodeOf(left, right);
  }

  Child child(uint32_t number, Place& next) {
    if ((number & kIsItem) == 0) {
      const uint32_t index = next.node;
      placeNode(number, next);
      return {nodes_[number].box, index, 0};
    }
    const uint32_t item = order_[number & ~kIsItem];
    result_.order[next.item] = item;
    return {boxes_[item], next.item++, 1};
  }

  std::span<const Box> boxes_;
  std::span<const uint32_t> order_;
  const Node* nodes_;
  std::span<const Cluster> clusters_;
  const Bvh& top_;
  std::vector<Place> places_; // of clusters
  Place next_{0, 0};
  Bvh result_;
};

} // namespace

Bvh buildFastBvh(std::span<const Box> boxes, uint32_t threads) {
  BvhBuildOptions options{.maxLeafItems = 1, .threads = threads};
  const auto count = static_cast<uint32_t>(boxes.size());
  if (count <= kChunk) return buildBvh(boxes, options);
  TM t;
  threads = threadCount(threads);
  Box all;
  for (const Box& box : boxes) all.grow(box);
  const float scale = scaleOf(all);
  t("bounds");
  const std::vector<uint32_t> order = zOrder(boxes, threads);
  t("zorder");

  const auto nodes = std::make_unique_for_overwrite<Node[]>(count);
  const uint32_t chunks = (count + kChunk - 1) / kChunk;
  std::vector<std::vector<Cluster>> found(chunks);
  parallelFor(chunks, threads, [&](uint32_t chunk) {
    const uint32_t first = chunk * kChunk;
    Agglomeration agglomeration(boxes, std::span(order).subspan(first, std::min(kChunk, count - first)), first, scale,
                                nodes.get() + first);
    const std::span<const Cluster> clusters = agglomeration.run();
    found[chunk].assign(clusters.begin(), clusters.end());
  });
  t("ploc");
  std::vector<Cluster> clusters;
  std::vector<Box> tops;
  for (const std::vector<Cluster>& some : found) clusters.insert(clusters.end(), some.begin(), some.end());
  if (clusters.size() >> kMaxTopDepth != 0) return buildBvh(boxes, options);
  for (const Cluster& cluster : clusters) tops.push_back(cluster.box);
  options.maxDepth = kMaxTopDepth;
  t("gather");
  const Bvh top = buildBvh(tops, options);
  t("top");
  Bvh r= Graft(boxes, order, nodes.get(), clusters, top).run(threads);
  t("graft");
  return r;
}

} // namespace isophote
