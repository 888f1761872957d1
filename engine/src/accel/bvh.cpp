#include "accel/bvh.hpp"

#include <algorithm>
#include <array>
#include <future>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

#include "accel/parallel_for.hpp"

namespace isophote {
namespace {

constexpr uint32_t kMaxBins = 16;

// Ranges below this are not worth a thread: at about 0.2 us per item and level the work is some 10 ms.
constexpr uint32_t kMinItemsPerThread = 8192;

// Threads per core: splits are uneven, the system's scheduler levels them out.
constexpr uint32_t kThreadsPerCore = 4;

struct Item {
  Box box;
  uint32_t number;
};

// A contiguous part of the item array with its bounds.
struct Range {
  uint32_t first = 0;
  uint32_t count = 0;
  Box box;
};

// Halved before the sum: the sum of two finite floats may overflow.
glm::vec3 center(const Box& box) { return 0.5f * box.lower + 0.5f * box.upper; }

struct Bin {
  Box box;
  uint32_t count = 0;
};

// Maps centers on one axis to bins.
struct Binning {
  double lower = 0;
  double scale = 0; // 0: all centers coincide on this axis
  uint32_t bins = 0;

  Binning(float from, float to, uint32_t binCount) : lower(from), bins(binCount) {
    const double extent = static_cast<double>(to) - lower;
    if (extent > 0) scale = binCount / extent;
  }
  [[nodiscard]] uint32_t bin(float value) const {
    return std::min(static_cast<uint32_t>((static_cast<double>(value) - lower) * scale), bins - 1);
  }
};

struct Plane {
  int axis = 0;
  uint32_t bin = 0; // items in bins below this go left
  uint32_t leftCount = 0;
  double cost = std::numeric_limits<double>::infinity(); // sum over both sides of half area x items
};

struct Halves {
  Range left, right;
};

// The cheapest plane between the bins of one axis (Wald 2007, "On fast Construction of SAH-based Bounding Volume
// Hierarchies", section 3).
void improvePlane(std::span<const Bin> bins, int axis, Plane& best) {
  std::array<double, kMaxBins> rightCost{};
  Box box;
  uint32_t count = 0;
  for (size_t i = bins.size() - 1; i > 0; --i) {
    box.grow(bins[i].box);
    count += bins[i].count;
    rightCost[i] = halfArea(box) * count;
  }
  const uint32_t total = count + bins[0].count;
  box = {};
  count = 0;
  for (size_t i = 1; i < bins.size(); ++i) {
    box.grow(bins[i - 1].box);
    count += bins[i - 1].count;
    if (count == 0 || count == total) continue;
    const double cost = halfArea(box) * count + rightCost[i];
    if (cost < best.cost) best = {axis, static_cast<uint32_t>(i), count, cost};
  }
}

// A leaf (count > 0) or the root of a subtree as its parent sees it.
struct Child {
  Box box;
  uint32_t index = 0;
  uint32_t count = 0;
  uint32_t depth = 0; // inner nodes down to the deepest leaf
};

BinaryNode nodeOf(const Child& left, const Child& right) {
  return {left.box.lower,  left.index,  left.box.upper,  left.count,
          right.box.lower, right.index, right.box.upper, right.count};
}

class Builder {
public:
  Builder(std::span<Item> items, const BvhBuildOptions& options) : items_(items), options_(options) {}

  // Appends the subtree below a node made of `halves`, depth first; its root is the first node appended.
  // `levels`: inner nodes allowed from this one to a leaf, itself included. Returns how many there are.
  uint32_t build(const Halves& halves, uint32_t levels, uint32_t threads, UnsetVector<BinaryNode>& nodes) {
    const size_t self = nodes.size();
    nodes.emplace_back();
    const bool parallel = threads > 1 && std::min(halves.left.count, halves.right.count) >= kMinItemsPerThread;
    Child left, right;
    if (parallel) {
      std::tie(left, right) = buildInParallel(halves, levels - 1, threads, nodes);
    } else {
      left = buildChild(halves.left, levels - 1, threads, nodes);
      right = buildChild(halves.right, levels - 1, threads, nodes);
    }
    nodes[self] = nodeOf(left, right);
    return 1 + std::max(left.depth, right.depth);
  }

  // Splits `range` in two, or returns nothing where it should be a leaf.
  std::optional<Halves> split(const Range& range, uint32_t levels) {
    if (range.count <= 1 || levels == 0) return std::nullopt;
    const bool mayBeLeaf = range.count <= options_.maxLeafItems;
    Box centers;
    for (const Item& item : itemsOf(range)) centers.grow(center(item.box));
    const uint32_t bins = std::clamp(2 * std::min(range.count, kMaxBins), 4u, kMaxBins);
    const std::array<Binning, 3> binning{Binning(centers.lower.x, centers.upper.x, bins),
                                         Binning(centers.lower.y, centers.upper.y, bins),
                                         Binning(centers.lower.z, centers.upper.z, bins)};
    const Plane plane = bestPlane(range, binning);
    const bool hasPlane = plane.cost < std::numeric_limits<double>::infinity();
    if (mayBeLeaf && (!hasPlane || !worthSplitting(range, plane))) return std::nullopt;
    const uint32_t larger = std::max(plane.leftCount, range.count - plane.leftCount);
    if (hasPlane && larger <= capacity(levels - 1)) return partition(range, plane, binning[plane.axis]);
    return splitAtMedian(range, centers);
  }

private:
  [[nodiscard]] std::span<Item> itemsOf(const Range& range) const { return items_.subspan(range.first, range.count); }

  // Items that fit below `levels` inner nodes.
  [[nodiscard]] uint64_t capacity(uint32_t levels) const {
    return static_cast<uint64_t>(options_.maxLeafItems) << levels;
  }

  [[nodiscard]] bool worthSplitting(const Range& range, const Plane& plane) const {
    const double area = halfArea(range.box);
    const double leaf = static_cast<double>(options_.itemCost) * range.count * area;
    return options_.nodeCost * area + options_.itemCost * plane.cost < leaf;
  }

  [[nodiscard]] Plane bestPlane(const Range& range, const std::array<Binning, 3>& binning) const {
    std::array<std::array<Bin, kMaxBins>, 3> bins;
    for (const Item& item : itemsOf(range)) {
      const glm::vec3 c = center(item.box);
      for (int axis = 0; axis < 3; ++axis) {
        Bin& bin = bins[axis][binning[axis].bin(c[axis])];
        bin.box.grow(item.box);
        ++bin.count;
      }
    }
    Plane best;
    for (int axis = 0; axis < 3; ++axis) {
      if (binning[axis].scale > 0) improvePlane(std::span(bins[axis]).first(binning[axis].bins), axis, best);
    }
    return best;
  }

  [[nodiscard]] Halves halvesAt(const Range& range, uint32_t leftCount) const {
    Halves halves{{range.first, leftCount, {}}, {range.first + leftCount, range.count - leftCount, {}}};
    for (const Item& item : itemsOf(halves.left)) halves.left.box.grow(item.box);
    for (const Item& item : itemsOf(halves.right)) halves.right.box.grow(item.box);
    return halves;
  }

  [[nodiscard]] Halves partition(const Range& range, const Plane& plane, const Binning& binning) const {
    const auto items = itemsOf(range);
    std::partition(items.begin(), items.end(),
                   [&](const Item& item) { return binning.bin(center(item.box)[plane.axis]) < plane.bin; });
    return halvesAt(range, plane.leftCount);
  }

  // Halves by number of items along the widest axis. Items whose centers coincide are told apart by their number.
  [[nodiscard]] Halves splitAtMedian(const Range& range, const Box& centers) const {
    const glm::dvec3 extent = glm::dvec3(centers.upper) - glm::dvec3(centers.lower);
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    const auto items = itemsOf(range);
    const uint32_t half = range.count / 2;
    std::nth_element(items.begin(), items.begin() + half, items.end(), [axis](const Item& a, const Item& b) {
      const float ca = center(a.box)[axis];
      const float cb = center(b.box)[axis];
      return ca != cb ? ca < cb : a.number < b.number;
    });
    return halvesAt(range, half);
  }

  // A leaf, or a subtree appended to `nodes`.
  Child buildChild(const Range& range, uint32_t levels, uint32_t threads, UnsetVector<BinaryNode>& nodes) {
    const std::optional<Halves> halves = split(range, levels);
    if (!halves) return {range.box, range.first, range.count, 0};
    const auto index = static_cast<uint32_t>(nodes.size());
    return {range.box, index, 0, build(*halves, levels, threads, nodes)};
  }

  // Appends the same nodes in the same order as two calls of buildChild, the left half on a thread of its own.
  std::pair<Child, Child> buildInParallel(const Halves& halves, uint32_t levels, uint32_t threads,
                                          UnsetVector<BinaryNode>& nodes) {
    UnsetVector<BinaryNode> leftNodes, rightNodes;
    auto pending =
        std::async(std::launch::async, [&] { return buildChild(halves.left, levels, threads / 2, leftNodes); });
    Child right = buildChild(halves.right, levels, threads - threads / 2, rightNodes);
    Child left = pending.get();
    append(leftNodes, left, nodes);
    append(rightNodes, right, nodes);
    return {left, right};
  }

  // Moves a subtree with indices of its own to the end of `nodes`.
  static void append(UnsetVector<BinaryNode>& part, Child& root, UnsetVector<BinaryNode>& nodes) {
    const auto offset = static_cast<uint32_t>(nodes.size());
    for (BinaryNode& node : part) {
      if (node.count0 == 0) node.child0 += offset;
      if (node.count1 == 0) node.child1 += offset;
    }
    if (root.count == 0) root.index += offset;
    nodes.insert(nodes.end(), part.begin(), part.end());
  }

  std::span<Item> items_;
  const BvhBuildOptions& options_;
};

} // namespace

Bvh buildBvh(std::span<const Box> boxes, const BvhBuildOptions& options) {
  std::vector<Item> items(boxes.size());
  Range all{0, static_cast<uint32_t>(boxes.size()), {}};
  for (uint32_t i = 0; i < all.count; ++i) {
    items[i] = {boxes[i], i};
    all.box.grow(boxes[i]);
  }

  Bvh bvh;
  bvh.bounds = all.box;
  Builder builder(items, options);
  if (const auto halves = builder.split(all, options.maxDepth)) {
    const uint32_t cores = threadCount(options.threads);
    const uint32_t threads = cores == 1 ? 1 : cores * kThreadsPerCore;
    bvh.maxDepth = builder.build(*halves, options.maxDepth, threads, bvh.nodes);
  } else {
    bvh.nodes.push_back(nodeOf({all.box, 0, all.count, 0}, {}));
    bvh.maxDepth = 1;
  }
  bvh.order.reserve(items.size());
  for (const Item& item : items) bvh.order.push_back(item.number);
  return bvh;
}

} // namespace isophote
