// Builds a BVH and books the time.
#pragma once

#include <chrono>
#include <span>

#include "accel/bvh.hpp"
#include "accel/fast_bvh.hpp"
#include "accel/wide_bvh.hpp"
#include "isophote/settings.hpp"
#include "upload/pack_scene.hpp"

namespace isophote {

[[nodiscard]] inline WideBvh buildTimedBvh(std::span<const Box> boxes, uint32_t maxLeafItems, BvhBuild build,
                                           BvhStatistics& statistics) {
  const auto start = std::chrono::steady_clock::now();
  const Bvh binary = build == BvhBuild::FastBuild ? buildFastBvh(boxes) : buildBvh(boxes, {.maxLeafItems = 1});
  WideBvh bvh = widenBvh(binary, {.maxLeafItems = maxLeafItems});
  statistics.milliseconds +=
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return bvh;
}

} // namespace isophote
