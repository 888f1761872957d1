#include "rendering/adaptive.hpp"

#include <algorithm>
#include <limits>

namespace isophote::cli {

std::optional<AdaptivePlan> planSamples(PathTracer& tracer, const Camera& camera, const Film& film,
                                        const Device& device, uint64_t seed, uint32_t pilotSamples,
                                        const std::function<bool()>& goOn) {
  constexpr uint64_t kPilot = 0x70696c6f74; // other random numbers than the image's
  FilmOptions options = film.options();
  options.aovs = options.clampLedger = options.depthLedger = false;
  Film pilot(device, options);
  tracer.setSeed(seed ^ kPilot);
  const double before = tracer.statistics().renderSeconds;
  const bool finished = tracer.render(camera, pilot, {0, pilotSamples}, [&](const Progress&) { return goOn(); });
  tracer.setSeed(seed);
  if (!finished) return std::nullopt;
  return AdaptivePlan{.allocation = allocateSamples(pilot.resolve()),
                      .pilotSamples = pilotSamples,
                      .pilotSeconds = tracer.statistics().renderSeconds - before};
}

bool renderAllocated(PathTracer& tracer, const Camera& camera, Film& film, SampleRange range,
                     const SampleAllocation& allocation, const std::function<bool(const Progress&)>& onProgress) {
  constexpr uint64_t kMost = std::numeric_limits<uint32_t>::max();
  double work = 0;
  for (uint32_t c = 0; c < SampleAllocation::kClasses; ++c)
    work += double(SampleAllocation::weight(c)) * static_cast<double>(allocation.pixels[c].size());
  double done = 0;
  uint64_t rays = 0;
  bool finished = true;
  for (uint32_t c = 0; c < SampleAllocation::kClasses && finished; ++c) {
    if (allocation.pixels[c].empty()) continue;
    const uint64_t weight = SampleAllocation::weight(c);
    const double share = double(weight) * static_cast<double>(allocation.pixels[c].size()) / work;
    uint64_t raysOfClass = 0;
    tracer.setPixels(allocation.pixels[c]);
    finished = tracer.render(camera, film,
                             {static_cast<uint32_t>(std::min(weight * range.first, kMost)),
                              static_cast<uint32_t>(std::min(weight * range.last, kMost))},
                             [&](const Progress& progress) {
                               raysOfClass = progress.rays;
                               return onProgress({.fraction = done + share * progress.fraction,
                                                  .seconds = progress.seconds,
                                                  .rays = rays + raysOfClass});
                             });
    done += share;
    rays += raysOfClass;
  }
  tracer.setPixels({});
  return finished;
}

} // namespace isophote::cli
