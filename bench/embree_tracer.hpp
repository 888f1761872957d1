// The same triangles and rays in Embree, on all cores.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "isophote/ray_bench.hpp"

namespace isophote::bench {

constexpr uint32_t kNothingMet = 0xffffffffu;

struct EmbreeHit {
  float t = 0;
  uint32_t triangle = kNothingMet;
};

class EmbreeTracer {
public:
  /// @param corners  three per triangle, world space
  explicit EmbreeTracer(std::span<const glm::vec3> corners);
  ~EmbreeTracer();

  [[nodiscard]] double buildSeconds() const;
  /// Rays one by one (rtcIntersect1, rtcOccluded1) or in packets of eight.
  /// Occluded rays report triangle 0.
  void trace(const RayList& list, bool packets, std::vector<EmbreeHit>& hits) const;

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace isophote::bench
