// Samples where the error is: `isophote render --adaptive`.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "isophote/path_tracer.hpp"
#include "isophote/sample_allocation.hpp"

namespace isophote::cli {

/// How an image's samples are shared out. What told is spent: its samples have no part in the image.
struct AdaptivePlan {
  SampleAllocation allocation;
  uint32_t pilotSamples = 0; ///< a pixel
  double pilotSeconds = 0;
};

/// Renders the pilot with random numbers of its own. @return nothing where `goOn` ended it
[[nodiscard]] std::optional<AdaptivePlan> planSamples(PathTracer& tracer, const Camera& camera, const Film& film,
                                                      const Device& device, uint64_t seed, uint32_t pilotSamples,
                                                      const std::function<bool()>& goOn);

/// Takes the samples `range` of a pixel of the first class, and as many times more of the others as their weights say;
/// progress is that of them all. @return false where `onProgress` ended it
bool renderAllocated(PathTracer& tracer, const Camera& camera, Film& film, SampleRange range,
                     const SampleAllocation& allocation, const std::function<bool(const Progress&)>& onProgress);

} // namespace isophote::cli
