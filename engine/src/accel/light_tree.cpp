#include "accel/light_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <future>
#include <limits>
#include <numeric>
#include <thread>

#include "accel/light_cone.hpp"

namespace isophote {
namespace {

constexpr int kBuckets = 12;
// Of all lights with and without a place, neither group is chosen less often than this where both exist: the powers
// say little about a point, and so no estimate gets worse than 1 / kSmallestGroupShare of the best division's variance.
constexpr double kSmallestGroupShare = 0.25;
// Lights with less than this share of the intensity count as having it: device numbers stay in range.
constexpr double kSmallestIntensityShare = 1e-20;

// Fewer lights are not worth a thread: at about 0.2 us per light and level the work is some 10 ms.
constexpr size_t kMinLightsPerThread = 4096;
// Splits are uneven, the system's scheduler levels them out.
constexpr uint32_t kThreadsPerCore = 4;

struct Cluster {
  glm::dvec3 lower{std::numeric_limits<double>::infinity()};
  glm::dvec3 upper{-std::numeric_limits<double>::infinity()};
  LightCone cone;
  double intensity = 0;
  bool empty = true;

  void add(const Cluster& other) {
    if (other.empty) return;
    lower = glm::min(lower, other.lower);
    upper = glm::max(upper, other.upper);
    cone = empty ? other.cone : unite(cone, other.cone);
    intensity += other.intensity;
    empty = false;
  }
  [[nodiscard]] glm::dvec3 center() const { return 0.5 * (lower + upper); }
  // The paper's measure of area is the box's surface; here it is that of the sphere around it, which enters the
  // importance, and which lights on a line have, too.
  [[nodiscard]] double cost() const {
    const glm::dvec3 diagonal = upper - lower;
    return empty ? 0 : intensity * solidAngleMeasure(cone) * glm::dot(diagonal, diagonal);
  }
};

struct Item {
  Cluster cluster;
  uint32_t light;
};

class Builder {
public:
  explicit Builder(std::span<const LightBound> lights) : lights_(lights) {
    tree_.trails.assign(lights.size(), gpu::kNoLightTrail);
  }

  LightTree build() {
    gatherFinite();
    std::vector<uint32_t> infinite;
    for (uint32_t i = 0; i < lights_.size(); ++i) {
      if (lights_[i].infinite && lights_[i].power > 0) infinite.push_back(i);
    }
    if (items_.empty() && infinite.empty()) return std::move(tree_);
    tree_.nodes.resize(1);
    if (infinite.empty()) {
      buildFinite(0, 0, 0);
    } else if (items_.empty()) {
      buildInfinite(0, infinite, 0, 0);
    } else {
      buildBoth(infinite);
    }
    return std::move(tree_);
  }

private:
  // Positions are scaled to at most 1, intensities to a sum of 1.
  void gatherFinite() {
    double largest = 0;
    double total = 0;
    for (const LightBound& light : lights_) {
      if (light.infinite || !(light.intensity > 0)) continue;
      for (int k = 0; k < 3; ++k) largest = std::max({largest, std::abs(light.lower[k]), std::abs(light.upper[k])});
      total += light.intensity;
    }
    tree_.scale = largest > 0 ? static_cast<float>(std::clamp(1 / largest, 1e-30, 1e30)) : 1.0f;
    for (uint32_t i = 0; i < lights_.size(); ++i) {
      const LightBound& light = lights_[i];
      if (light.infinite || !(light.intensity > 0)) continue;
      Cluster cluster;
      cluster.lower = light.lower * static_cast<double>(tree_.scale);
      cluster.upper = light.upper * static_cast<double>(tree_.scale);
      cluster.cone = {light.axis, light.thetaO, light.thetaE, light.twoSided};
      cluster.intensity = std::max(light.intensity / total, kSmallestIntensityShare);
      cluster.empty = false;
      items_.push_back({cluster, i});
    }
  }

  void buildBoth(const std::vector<uint32_t>& infinite) {
    double infinitePower = 0;
    double finitePower = 0;
    for (const LightBound& light : lights_) (light.infinite ? infinitePower : finitePower) += light.power;
    const double share =
        std::clamp(infinitePower / (infinitePower + finitePower), kSmallestGroupShare, 1 - kSmallestGroupShare);
    const uint32_t first = split(0);
    buildInfinite(first, infinite, 1, 0);
    setFixed(first, share);
    buildFinite(first + 1, 1, 1);
    setFixed(first + 1, 1 - share);
  }

  void buildInfinite(uint32_t node, std::span<const uint32_t> lights, uint32_t depth, uint32_t trail) {
    double power = 0;
    double largest = 0;
    for (const LightBound& light : lights_) {
      if (light.infinite) largest = std::max(largest, light.power);
    }
    for (const uint32_t i : lights) power += std::max(lights_[i].power / largest, kSmallestIntensityShare);
    setFixed(node, power);
    if (lights.size() == 1) return setLeaf(node, lights[0], trail);
    const uint32_t first = split(node);
    const size_t half = lights.size() / 2;
    buildInfinite(first, lights.subspan(0, half), depth + 1, trail);
    buildInfinite(first + 1, lights.subspan(half), depth + 1, trail | 1u << depth);
  }

  // A tree of n lights has 2n - 1 nodes: those below `node` are [below, below + 2n - 2), in the order of a depth-first
  // build whoever builds them.
  void buildFinite(uint32_t node, uint32_t below, size_t begin, size_t end, uint32_t depth, uint32_t trail,
                   uint32_t threads) {
    Cluster all;
    for (size_t i = begin; i < end; ++i) all.add(items_[i].cluster);
    setCluster(node, all);
    if (end - begin == 1) return setLeaf(node, items_[begin].light, trail);
    const size_t middle = partition(begin, end, all, depth);
    tree_.nodes[node].child = below | (all.cone.twoSided ? gpu::kLightTreeTwoSided : 0);
    const auto belowFirst = below + 2;
    const auto belowSecond = belowFirst + 2 * static_cast<uint32_t>(middle - begin) - 2;
    const auto first = [=, this] { buildFinite(below, belowFirst, begin, middle, depth + 1, trail, threads / 2); };
    std::future<void> pending;
    if (threads > 1 && std::min(middle - begin, end - middle) >= kMinLightsPerThread) {
      pending = std::async(std::launch::async, first);
    } else {
      first();
    }
    buildFinite(below + 1, belowSecond, middle, end, depth + 1, trail | 1u << depth, threads - threads / 2);
    if (pending.valid()) pending.get();
  }

  void buildFinite(uint32_t node, uint32_t depth, uint32_t trail) {
    const auto below = static_cast<uint32_t>(tree_.nodes.size());
    tree_.nodes.resize(below + 2 * items_.size() - 2);
    const uint32_t cores = std::max(1u, std::thread::hardware_concurrency());
    buildFinite(node, below, 0, items_.size(), depth, trail, cores == 1 ? 1 : cores * kThreadsPerCore);
  }

  // Orders items [begin, end) so that the first child's come first; returns where the second child's start.
  size_t partition(size_t begin, size_t end, const Cluster& all, uint32_t depth) {
    const size_t roomPerChild = size_t{1} << (gpu::kLightTreeMaxDepth - depth - 1);
    Cluster centers;
    for (size_t i = begin; i < end; ++i) {
      const glm::dvec3 center = items_[i].cluster.center();
      centers.lower = glm::min(centers.lower, center);
      centers.upper = glm::max(centers.upper, center);
    }
    const Split best = bestSplit(begin, end, all, centers);
    const auto from = items_.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto to = items_.begin() + static_cast<std::ptrdiff_t>(end);
    if (best.axis >= 0) {
      const auto middle = std::stable_partition(
          from, to, [&](const Item& item) { return bucketOf(item.cluster, centers, best.axis) < best.bucket; });
      const auto left = static_cast<size_t>(middle - from);
      const size_t right = end - begin - left;
      if (std::max(left, right) <= roomPerChild) return begin + left;
    }
    const glm::dvec3 extent = centers.upper - centers.lower;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : (extent.y >= extent.z ? 1 : 2);
    std::stable_sort(from, to,
                     [&](const Item& a, const Item& b) { return a.cluster.center()[axis] < b.cluster.center()[axis]; });
    return begin + (end - begin) / 2;
  }

  struct Split {
    int axis = -1;  // none
    int bucket = 0; // the first of the second child
    double cost = std::numeric_limits<double>::infinity();
  };

  [[nodiscard]] static int bucketOf(const Cluster& cluster, const Cluster& centers, int axis) {
    const double extent = centers.upper[axis] - centers.lower[axis];
    const double place = (cluster.center()[axis] - centers.lower[axis]) / extent;
    return std::clamp(static_cast<int>(place * kBuckets), 0, kBuckets - 1);
  }

  [[nodiscard]] Split bestSplit(size_t begin, size_t end, const Cluster& all, const Cluster& centers) const {
    std::array<std::array<Cluster, kBuckets>, 3> bucketsOfAxes;
    for (size_t i = begin; i < end; ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        if (!(centers.upper[axis] > centers.lower[axis])) continue;
        const Cluster& cluster = items_[i].cluster;
        bucketsOfAxes[static_cast<size_t>(axis)][static_cast<size_t>(bucketOf(cluster, centers, axis))].add(cluster);
      }
    }
    Split best;
    const glm::dvec3 size = all.upper - all.lower;
    const double longest = std::max({size.x, size.y, size.z});
    for (int axis = 0; axis < 3; ++axis) {
      if (!(centers.upper[axis] > centers.lower[axis])) continue;
      const std::array<Cluster, kBuckets>& buckets = bucketsOfAxes[static_cast<size_t>(axis)];
      // An empty bucket changes neither side: its costs are its neighbor's. Few lights leave most buckets empty.
      std::array<double, kBuckets> above{}; // cost of buckets i and up
      std::array<bool, kBuckets> filled{};
      Cluster sum;
      double cost = 0;
      for (size_t i = kBuckets - 1; i > 0; --i) {
        if (!buckets[i].empty) {
          sum.add(buckets[i]);
          cost = sum.cost();
        }
        above[i] = cost;
        filled[i] = !sum.empty;
      }
      sum = {};
      for (size_t i = 1; i < kBuckets; ++i) {
        if (buckets[i - 1].empty || !filled[i]) continue;
        sum.add(buckets[i - 1]);
        cost = longest / size[axis] * (sum.cost() + above[i]);
        if (cost < best.cost) best = {axis, static_cast<int>(i), cost};
      }
    }
    return best;
  }

  uint32_t split(uint32_t node) {
    const auto first = static_cast<uint32_t>(tree_.nodes.size());
    tree_.nodes.resize(first + 2);
    tree_.nodes[node].child = first;
    return first;
  }

  void setLeaf(uint32_t node, uint32_t light, uint32_t trail) {
    tree_.nodes[node].child = light | gpu::kLightTreeLeaf;
    if (lights_[light].twoSided && !lights_[light].infinite) tree_.nodes[node].child |= gpu::kLightTreeTwoSided;
    tree_.trails[light] = trail;
  }

  void setFixed(uint32_t node, double weight) {
    tree_.nodes[node].intensity = static_cast<float>(weight);
    tree_.nodes[node].extent.x = gpu::kLightTreeFixed;
  }

  void setCluster(uint32_t node, const Cluster& cluster) {
    gpu::LightTreeNode& out = tree_.nodes[node];
    const glm::dvec3 center = cluster.center();
    out.center = glm::vec3(center);
    // Room for the rounding of the center and of the points that the device compares with it.
    const double slack = 1e-6 * std::max({std::abs(center.x), std::abs(center.y), std::abs(center.z), 1e-6});
    out.extent = glm::vec3(0.5 * (1 + 1e-6) * (cluster.upper - cluster.lower) + slack);
    out.intensity = static_cast<float>(cluster.intensity);
    const PackedCone packed = pack(cluster.cone);
    out.axis = packed.axis;
    out.cosines = packed.cosines;
  }

  std::span<const LightBound> lights_;
  std::vector<Item> items_;
  LightTree tree_;
};

} // namespace

LightTree buildLightTree(std::span<const LightBound> lights) { return Builder(lights).build(); }

} // namespace isophote
