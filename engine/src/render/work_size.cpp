#include "render/work_size.hpp"

#include <algorithm>
#include <cmath>

namespace isophote {
namespace {

constexpr uint32_t kMostSteps = 1024;
// Watchdogs kill long dispatches, and Ctrl-C must be answered: above this the pool is not used in full.
constexpr double kLongestDispatchMilliseconds = 100;
constexpr uint32_t kFewestActivePaths = 256;

uint32_t scaled(uint32_t count, double ratio, uint32_t most) {
  return static_cast<uint32_t>(std::clamp(std::round(count * ratio), 1.0, static_cast<double>(most)));
}

} // namespace

void WorkSize::follow(Pipeline pipeline, double submitMilliseconds, double longestDispatchMilliseconds,
                      bool startsPaths) {
  const bool fused = pipeline == Pipeline::Fused;
  const double limit = std::min(kLongestDispatchMilliseconds, submitMilliseconds_);
  // A submit of the fused kernel is one dispatch.
  const double wanted = fused ? limit : submitMilliseconds_;
  const double ratio = std::clamp(wanted / std::max(submitMilliseconds, 0.1), 0.25, 2.0);
  if (fused) {
    steps_ = scaled(steps_, ratio, kMostSteps);
    if (startsPaths) fullSteps_ = steps_;
  } else {
    waves_ = scaled(waves_, ratio, kMostWaves);
  }
  // The fused kernel gets fewer steps before it gets fewer paths, and more paths before more steps.
  const bool fewerStepsWillDo = fused && steps_ > 1;
  if (longestDispatchMilliseconds > limit && !fewerStepsWillDo) {
    const double smaller = activeLimit_ * std::max(0.25, limit / longestDispatchMilliseconds * 0.8);
    activeLimit_ = std::max(kFewestActivePaths, static_cast<uint32_t>(smaller));
  } else if ((longestDispatchMilliseconds < 0.5 * limit || fewerStepsWillDo) && activeLimit_ < capacity_) {
    activeLimit_ = std::min(capacity_, activeLimit_ + activeLimit_ / 4);
  }
}

} // namespace isophote
