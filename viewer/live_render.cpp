#include "viewer/live_render.hpp"

#include <algorithm>

namespace isophote::viewer {
namespace {

constexpr uint32_t kCoarseness = 4;        // full pixels a side of one coarse pixel
constexpr uint32_t kLargestBatch = 16;     // a save waits for the end of a batch
constexpr uint32_t kMostSamples = 1 << 24; // far below where the film's sums could overflow

Film makeFilm(const Device& device, uint32_t width, uint32_t height) {
  return {device, FilmOptions{.width = std::max(width, 1u), .height = std::max(height, 1u)}};
}

} // namespace

LiveRender::LiveRender(const Device& device, const GpuScene& scene, uint32_t width, uint32_t height,
                       const ExecutionSettings& execution)
    : coarse_(makeFilm(device, width / kCoarseness, height / kCoarseness)), full_(makeFilm(device, width, height)),
      tracer_(device, scene, {}, execution), startTime_(Clock::now()) {}

uint64_t LiveRender::rays() const {
  const RenderStatistics statistics = tracer_.statistics();
  return statistics.primaryRays + statistics.bounceRays + statistics.shadowRays;
}

void LiveRender::start(const Camera& camera) {
  tracer_.cancel();
  coarse_.clear();
  full_.clear();
  camera_ = camera;
  coarseDone_ = false;
  samples_ = 0;
  batch_ = 1;
  raysAtStart_ = rays();
  startTime_ = Clock::now();
  tracer_.begin(camera_, coarse_, {.first = 0, .last = 1});
}

bool LiveRender::step() {
  if (tracer_.advance()) return false;
  const bool fullBatchEnded = coarseDone_;
  if (fullBatchEnded) {
    samples_ += batch_;
    batch_ = std::min(samples_, kLargestBatch);
  }
  coarseDone_ = true;
  if (samples_ < kMostSamples) tracer_.begin(camera_, full_, {.first = samples_, .last = samples_ + batch_});
  return fullBatchEnded;
}

double LiveRender::raysPerSecond() const {
  const double seconds = std::chrono::duration<double>(Clock::now() - startTime_).count();
  return seconds > 0 ? static_cast<double>(rays() - raysAtStart_) / seconds : 0;
}

} // namespace isophote::viewer
