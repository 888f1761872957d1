#include "accel/wide_bvh.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <future>
#include <limits>
#include <memory>
#include <span>
#include <tuple>
#include <utility>

#include "accel/parallel_for.hpp"

namespace isophote {
namespace {

using gpu::kBvhItemsPerSlot;
using gpu::kBvhWidth;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr int kExponentBias = 127;
constexpr int kSmallestExponent = -100; // of a frame's size: boxes smaller than its cells need no frame of their own
constexpr int kLargestExponent = 127;
constexpr double kCells = gpu::kBvhFrameCells;

// Subtrees of fewer binary nodes are not worth a thread: at about 0.3 us a node the work is some 10 ms.
constexpr uint32_t kMinNodesPerThread = 32768;
// Subtrees are uneven, the system's scheduler levels them out.
constexpr uint32_t kThreadsPerCore = 4;
constexpr uint32_t kSubtreesPerThread = 16;

// A child of a wide node: a subtree of the binary tree with its items.
struct Child {
  Box box;
  uint32_t index = 0; // of the binary node or, of a leaf of the binary tree, of the first item
  bool isNode = false;
  uint32_t itemCount = 0; // of a leaf; 0: inner
};

// How the items below a binary node are best made into at most 1 to 7 children of one wide node.
struct Forest {
  std::array<float, kBvhWidth> cost;       // [i]: of at most i children; [0] is not used
  std::array<uint8_t, kBvhWidth + 1> left; // [i]: children of i that the left half gets; 0: i - 1 are as good
  bool leaf;                               // whether the single child is a leaf
  uint32_t itemCount;
};

class Widener {
public:
  Widener(const Bvh& binary, const WideBvhOptions& options)
      : binary_(binary), options_(options), forests_(std::make_unique_for_overwrite<Forest[]>(binary.nodes.size())) {
    const double area = halfArea(binary.bounds);
    if (area > 0 && std::isfinite(area)) areaScale_ = std::ldexp(1, -std::ilogb(area));
  }

  WideBvh widen() {
    const uint32_t cores = threadCount(options_.threads);
    const uint32_t threads = cores == 1 ? 1 : cores * kThreadsPerCore;
    findForests(binary_.nodes.size() >= 2 * kMinNodesPerThread ? threads : 1);
    Subtree all = subtree(0, binary_.bounds, threads);
    const double area = halfArea(binary_.bounds);
    return {.nodes = std::move(all.nodes),
            .order = std::move(all.order),
            .maxDepth = all.depth,
            .sahCost = options_.nodeCost + (area > 0 ? all.cost / area : 0),
            .bounds = binary_.bounds};
  }

private:
  // Wide nodes, root first, with indices of their own.
  struct Subtree {
    std::vector<gpu::BvhNode> nodes;
    std::vector<uint32_t> order;
    uint32_t depth = 0; // levels
    double cost = 0;    // sum of half area x cost over children
  };

  struct Side {
    Box box;
    uint32_t child, count;
    [[nodiscard]] bool absent() const { return box.lower.x > box.upper.x; }
  };

  static Side side(const BinaryNode& node, bool right) {
    return right ? Side{{node.lower1, node.upper1}, node.child1, node.count1}
                 : Side{{node.lower0, node.upper0}, node.child0, node.count0};
  }

  // Of the order of 1 for the whole tree: squares of large coordinates do not fit a float.
  [[nodiscard]] float scaledArea(const Box& box) const { return static_cast<float>(halfArea(box) * areaScale_); }

  // Costs of at most i children, as Forest::cost.
  using Costs = std::array<float, kBvhWidth>;

  [[nodiscard]] Costs costsOf(const Side& side) const {
    if (side.count == 0) return forests_[side.child].cost;
    Costs costs;
    costs.fill(scaledArea(side.box) * options_.itemCost * static_cast<float>(side.count));
    return costs;
  }

  // Children before parents: below nodes of a level with enough of them on several threads, then those above.
  void findForests(uint32_t threads) {
    std::vector<uint32_t> above, level{0};
    while (!level.empty() && level.size() < kSubtreesPerThread * threads) {
      above.insert(above.end(), level.begin(), level.end());
      std::vector<uint32_t> next;
      for (const uint32_t node : level) {
        const BinaryNode& parent = binary_.nodes[node];
        for (const bool right : {false, true}) {
          const Side child = side(parent, right);
          if (child.count == 0 && !child.absent()) next.push_back(child.child);
        }
      }
      level = std::move(next);
    }
    parallelFor(static_cast<uint32_t>(level.size()), threads, [&](uint32_t i) { findForestsBelow(level[i]); });
    std::for_each(above.rbegin(), above.rend(), [&](uint32_t node) { findForest(node); });
  }

  void findForestsBelow(uint32_t node) {
    const BinaryNode& parent = binary_.nodes[node];
    if (parent.count0 == 0) findForestsBelow(parent.child0);
    if (parent.count1 == 0) findForestsBelow(parent.child1);
    findForest(node);
  }

  void findForest(uint32_t node) {
    const Side left = side(binary_.nodes[node], false);
    const Side right = side(binary_.nodes[node], true);
    if (!left.absent() && !right.absent()) findForest(left, right, forests_[node]); // else a root with one leaf or none
  }

  void findForest(const Side& left, const Side& right, Forest& forest) const {
    const uint32_t leftItems = left.count != 0 ? left.count : forests_[left.child].itemCount;
    const uint32_t rightItems = right.count != 0 ? right.count : forests_[right.child].itemCount;
    forest.itemCount = leftItems + rightItems;
    const Costs leftCosts = costsOf(left);
    const Costs rightCosts = costsOf(right);
    forest.left = {};
    const auto distribute = [&](uint32_t children) {
      float best = leftCosts[1] + rightCosts[children - 1];
      forest.left[children] = 1;
      for (uint32_t k = 2; k < children; ++k) {
        const float cost = leftCosts[k] + rightCosts[children - k];
        if (cost < best) {
          best = cost;
          forest.left[children] = static_cast<uint8_t>(k);
        }
      }
      return best;
    };
    const float all = distribute(kBvhWidth);
    Box box = left.box;
    box.grow(right.box);
    const float area = scaledArea(box);
    forest.cost[1] = all + area * options_.nodeCost;
    forest.leaf = false;
    if (forest.itemCount <= options_.maxLeafItems) {
      const float asLeaf = area * options_.itemCost * static_cast<float>(forest.itemCount);
      forest.leaf = asLeaf <= forest.cost[1];
      forest.cost[1] = std::min(forest.cost[1], asLeaf);
    }
    // More children than items are no use.
    const uint32_t useful = std::min(forest.itemCount, kBvhWidth - 1);
    for (uint32_t i = 2; i <= useful; ++i) {
      forest.cost[i] = distribute(i);
      if (forest.cost[i - 1] <= forest.cost[i]) {
        forest.cost[i] = forest.cost[i - 1];
        forest.left[i] = 0;
      }
    }
    for (uint32_t i = useful + 1; i < kBvhWidth; ++i) forest.cost[i] = forest.cost[useful];
  }

  void addChildren(const Side& side, uint32_t most, std::array<Child, kBvhWidth>& children, uint32_t& count) const {
    if (side.count != 0) {
      children[count++] = {side.box, side.child, false, side.count};
      return;
    }
    const Forest& forest = forests_[side.child];
    while (most > 1 && forest.left[most] == 0) --most;
    if (most == 1) {
      children[count++] = {side.box, side.child, true, forest.leaf ? forest.itemCount : 0};
      return;
    }
    distribute(side.child, most, children, count);
  }

  void distribute(uint32_t node, uint32_t most, std::array<Child, kBvhWidth>& children, uint32_t& count) const {
    const uint32_t left = forests_[node].left[most];
    addChildren(side(binary_.nodes[node], false), std::min(left, kBvhWidth - 1), children, count);
    addChildren(side(binary_.nodes[node], true), std::min(most - left, kBvhWidth - 1), children, count);
  }

  // The items of a leaf of the binary tree or, where count is 0, of all leaves below a node.
  void addItems(uint32_t child, uint32_t count, std::vector<uint32_t>& order) const {
    for (uint32_t i = 0; i < count; ++i) order.push_back(binary_.order[child + i]);
    if (count != 0) return;
    const BinaryNode& node = binary_.nodes[child];
    addItems(node.child0, node.count0, order);
    addItems(node.child1, node.count1, order);
  }

  // What is below a binary node.
  [[nodiscard]] Subtree subtree(uint32_t node, const Box& box, uint32_t threads) const {
    Subtree result;
    result.nodes.emplace_back();
    std::tie(result.depth, result.cost) = fill(result, 0, node, box, threads);
    return result;
  }

  // Fills wide node `self` with what is below a binary node. Returns the levels, itself included, and the cost below.
  std::pair<uint32_t, double> fill(Subtree& wide, uint32_t self, uint32_t node, const Box& box,
                                   uint32_t threads) const {
    std::array<Child, kBvhWidth> children;
    uint32_t count = 0;
    if (side(binary_.nodes[node], true).absent()) {
      const Side only = side(binary_.nodes[node], false);
      if (only.count != 0) children[count++] = {only.box, only.child, false, only.count};
    } else {
      distribute(node, kBvhWidth, children, count);
    }
    const std::array<const Child*, kBvhWidth> slots = assignSlots({children.data(), count}, box);
    wide.nodes[self] = encode(slots, box);

    const auto firstChild = static_cast<uint32_t>(wide.nodes.size());
    wide.nodes[self].firstChild = firstChild;
    wide.nodes[self].firstItem = static_cast<uint32_t>(wide.order.size());
    double cost = 0;
    std::array<const Child*, kBvhWidth> inner{};
    uint32_t innerCount = 0;
    for (const Child* child : slots) {
      if (child == nullptr) continue;
      cost += halfArea(child->box) *
              (child->itemCount != 0 ? options_.itemCost * static_cast<float>(child->itemCount) : options_.nodeCost);
      if (child->itemCount == 0) inner[innerCount++] = child;
      if (child->itemCount != 0) addItems(child->index, child->isNode ? 0 : child->itemCount, wide.order);
    }
    wide.nodes.resize(firstChild + innerCount);
    const std::span<const Child* const> subtrees(inner.data(), innerCount);
    const bool parallel = threads > 1 && innerCount > 0 && forests_[node].itemCount >= 2 * kMinNodesPerThread;
    const auto [depth, below] =
        parallel ? fillInParallel(wide, firstChild, subtrees, threads) : fillInTurn(wide, firstChild, subtrees);
    return {depth + 1, cost + below};
  }

  std::pair<uint32_t, double> fillInTurn(Subtree& wide, uint32_t first, std::span<const Child* const> children) const {
    uint32_t deepest = 0;
    double sum = 0;
    for (const Child* child : children) {
      const auto [depth, cost] = fill(wide, first++, child->index, child->box, 1);
      deepest = std::max(deepest, depth);
      sum += cost;
    }
    return {deepest, sum};
  }

  // The same nodes in the same order, each child's by a thread of its own.
  std::pair<uint32_t, double> fillInParallel(Subtree& wide, uint32_t first, std::span<const Child* const> children,
                                             uint32_t threads) const {
    std::vector<std::future<Subtree>> pending;
    const uint32_t share = std::max(1u, threads / static_cast<uint32_t>(std::max<size_t>(children.size(), 1)));
    for (const Child* child : children) {
      pending.push_back(std::async(std::launch::async, [=, this] { return subtree(child->index, child->box, share); }));
    }
    std::vector<Subtree> parts;
    for (std::future<Subtree>& future : pending) parts.push_back(future.get());
    size_t nodes = wide.nodes.size(), items = wide.order.size();
    for (const Subtree& part : parts) {
      nodes += part.nodes.size();
      items += part.order.size();
    }
    wide.nodes.reserve(nodes);
    wide.order.reserve(items);
    uint32_t deepest = 0;
    double sum = 0;
    for (Subtree& part : parts) {
      deepest = std::max(deepest, part.depth);
      sum += part.cost;
      append(wide, first++, part);
    }
    return {deepest, sum};
  }

  // Its root becomes node `root` of `wide`; the others follow what is there.
  static void append(Subtree& wide, uint32_t root, Subtree& part) {
    const auto nodes = static_cast<uint32_t>(wide.nodes.size()) - 1;
    const auto items = static_cast<uint32_t>(wide.order.size());
    for (gpu::BvhNode& node : part.nodes) {
      node.firstChild += nodes;
      node.firstItem += items;
    }
    wide.nodes[root] = part.nodes[0];
    wide.nodes.insert(wide.nodes.end(), part.nodes.begin() + 1, part.nodes.end());
    wide.order.insert(wide.order.end(), part.order.begin(), part.order.end());
  }

  // A slot is a corner of the node: a child goes towards the corner that its center is nearest to, so that slots in the
  // order of a ray's octant are roughly in the order of distance. The best of the remaining pairs, one after another.
  static std::array<const Child*, kBvhWidth> assignSlots(std::span<const Child> children, const Box& box) {
    std::array<std::array<float, kBvhWidth>, kBvhWidth> gain;                               // [child][slot]
    const auto center = [](const Box& b) { return 0.0625f * b.lower + 0.0625f * b.upper; }; // no sum overflows
    for (size_t c = 0; c < children.size(); ++c) {
      const glm::vec3 offset = center(children[c].box) - center(box);
      for (uint32_t slot = 0; slot < kBvhWidth; ++slot) {
        gain[c][slot] = ((slot & 1u) != 0 ? offset.x : -offset.x) + ((slot & 2u) != 0 ? offset.y : -offset.y) +
                        ((slot & 4u) != 0 ? offset.z : -offset.z);
      }
    }
    uint32_t taken = 0; // bits of slots
    const auto bestSlot = [&](size_t child) {
      float best = -kInfinity;
      uint32_t found = 0;
      for (uint32_t slot = 0; slot < kBvhWidth; ++slot) {
        const float value = (taken >> slot & 1u) != 0 ? -kInfinity : gain[child][slot];
        found = value > best ? slot : found;
        best = value > best ? value : best;
      }
      return found;
    };
    const auto all = static_cast<uint32_t>(children.size());
    std::array<uint32_t, kBvhWidth> waiting{}, wanted{}; // children without a slot, and the slot each wants
    for (uint32_t i = 0; i < all; ++i) {
      waiting[i] = i;
      wanted[i] = bestSlot(i);
    }
    std::array<const Child*, kBvhWidth> slots{};
    for (uint32_t left = all; left > 0; --left) {
      uint32_t next = 0;
      for (uint32_t i = 1; i < left; ++i) {
        if (gain[waiting[i]][wanted[i]] > gain[waiting[next]][wanted[next]]) next = i;
      }
      const uint32_t slot = wanted[next];
      slots[slot] = &children[waiting[next]];
      taken |= 1u << slot;
      for (uint32_t i = next + 1; i < left; ++i) { // those waiting stay in their order
        waiting[i - 1] = waiting[i];
        wanted[i - 1] = wanted[i];
      }
      for (uint32_t i = 0; i + 1 < left; ++i) {
        if (wanted[i] == slot) wanted[i] = bestSlot(waiting[i]);
      }
    }
    return slots;
  }

  // Power of two above all children's extent, so that no cell lies beyond the last.
  static int frameExponent(double extent) {
    int exponent = kSmallestExponent;
    if (extent > 0) exponent = std::clamp(std::ilogb(extent), kSmallestExponent, kLargestExponent);
    while (exponent < kLargestExponent && std::ceil(extent / std::ldexp(1 / kCells, exponent)) > kCells - 1) ++exponent;
    return exponent;
  }

  // Cells are numbered from 0 to kCells - 1; a child within its node has no negative ones.
  static uint32_t roundedDown(double cells) { return static_cast<uint32_t>(std::min(cells, kCells - 1)); }
  static uint32_t roundedUp(double cells) {
    const uint32_t down = roundedDown(cells);
    return down < kCells - 1 && down < cells ? down + 1 : down;
  }

  static gpu::BvhNode encode(const std::array<const Child*, kBvhWidth>& slots, const Box& box) {
    gpu::BvhNode node{};
    if (box.lower.x > box.upper.x) return node;
    node.origin = box.lower;
    for (int axis = 0; axis < 3; ++axis) {
      const double lower = box.lower[axis];
      const int exponent = frameExponent(static_cast<double>(box.upper[axis]) - lower);
      const double cells = std::ldexp(kCells, -exponent); // per unit of length
      node.exponents |= static_cast<uint32_t>(exponent + kExponentBias) << 8 * axis;
      for (uint32_t slot = 0; slot < kBvhWidth; ++slot) {
        if (slots[slot] == nullptr) continue;
        const Box& child = slots[slot]->box;
        const double from = (static_cast<double>(child.lower[axis]) - lower) * cells;
        const double to = (static_cast<double>(child.upper[axis]) - lower) * cells;
        const uint32_t shift = 8 * (slot % 4);
        node.lower[2 * axis + slot / 4] |= roundedDown(from) << shift;
        node.upper[2 * axis + slot / 4] |= roundedUp(to) << shift;
      }
    }
    for (uint32_t slot = 0; slot < kBvhWidth; ++slot) {
      if (slots[slot] == nullptr) continue;
      const uint32_t items = slots[slot]->itemCount;
      if (items == 0) {
        node.contents |= 1u << (gpu::kBvhInnerShift + slot);
      } else {
        node.contents |= ((1u << items) - 1) << (kBvhItemsPerSlot * slot);
      }
    }
    return node;
  }

  const Bvh& binary_;
  const WideBvhOptions& options_;
  std::unique_ptr<Forest[]> forests_; // of the nodes; none of a root with one leaf or none
  double areaScale_ = 1;              // a power of two: it changes no rounding
};

} // namespace

WideBvh widenBvh(const Bvh& binary, const WideBvhOptions& options) { return Widener(binary, options).widen(); }

Box childBox(const gpu::BvhNode& node, uint32_t slot) {
  const bool inner = (node.contents >> (gpu::kBvhInnerShift + slot) & 1u) != 0;
  const bool leaf = (node.contents >> (kBvhItemsPerSlot * slot) & ((1u << kBvhItemsPerSlot) - 1)) != 0;
  Box box;
  if (!inner && !leaf) return box;
  for (int axis = 0; axis < 3; ++axis) {
    const int exponent = static_cast<int>(node.exponents >> 8 * axis & 0xffu) - kExponentBias;
    const double cell = std::ldexp(1 / kCells, exponent);
    const uint32_t from = node.lower[2 * axis + slot / 4] >> 8 * (slot % 4) & 0xffu;
    const uint32_t to = node.upper[2 * axis + slot / 4] >> 8 * (slot % 4) & 0xffu;
    // Rounded outwards: the exact bound may lie between floats.
    box.lower[axis] = static_cast<float>(node.origin[axis] + from * cell);
    box.upper[axis] = static_cast<float>(node.origin[axis] + to * cell);
    if (box.lower[axis] > node.origin[axis] + from * cell)
      box.lower[axis] = std::nextafter(box.lower[axis], -kInfinity);
    if (box.upper[axis] < node.origin[axis] + to * cell) box.upper[axis] = std::nextafter(box.upper[axis], kInfinity);
  }
  return box;
}

} // namespace isophote
