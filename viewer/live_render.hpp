// A render that starts over whenever the camera moves.
#pragma once

#include <chrono>
#include <cstdint>

#include "isophote/path_tracer.hpp"

namespace isophote::viewer {

/// Two films: a coarse one that a moving camera fills within a frame, and the full one. Samples come in batches;
/// between batches no path is in flight, so that the full film is unbiased there and may be saved.
class LiveRender {
public:
  /// @param width, height  of the full film, in pixels
  LiveRender(const Device& device, const GpuScene& scene, uint32_t width, uint32_t height,
             const ExecutionSettings& execution);

  void start(const Camera& camera);
  /// One submit. @return whether a batch of the full film ended with it
  bool step();

  /// What to show: the coarse film until every pixel of the full one has a sample.
  [[nodiscard]] const Film& shown() const { return samples_ > 0 ? full_ : coarse_; }
  [[nodiscard]] const Film& film() const { return full_; }
  [[nodiscard]] uint32_t samples() const { return samples_; } ///< per pixel, of finished batches
  [[nodiscard]] double raysPerSecond() const;                 ///< since start
  [[nodiscard]] RenderStatistics statistics() const { return tracer_.statistics(); }

private:
  using Clock = std::chrono::steady_clock;

  Film coarse_;
  Film full_;
  PathTracer tracer_;
  Camera camera_;
  bool coarseDone_ = false;
  uint32_t samples_ = 0;
  uint32_t batch_ = 1;
  uint64_t raysAtStart_ = 0;
  Clock::time_point startTime_;

  [[nodiscard]] uint64_t rays() const;
};

} // namespace isophote::viewer
