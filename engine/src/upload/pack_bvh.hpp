// Builds a BVH and books the time.
#pragma once

#include <chrono>
#include <span>

#include "accel/bvh.hpp"
#include "accel/wide_bvh.hpp"
#include "upload/pack_scene.hpp"

namespace isophote {

[[nodiscard]] inline WideBvh buildTimedBvh(std::span<const Box> boxes, uint32_t maxLeafItems,
                                           BvhStatistics& statistics) {
  const auto start = std::chrono::steady_clock::now();
  WideBvh bvh = widenBvh(buildBvh(boxes, {.maxLeafItems = 1}), {.maxLeafItems = maxLeafItems});
  statistics.milliseconds +=
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return bvh;
}

} // namespace isophote
