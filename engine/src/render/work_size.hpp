// How much work one submit gets.
#pragma once

#include <cstdint>

#include "isophote/settings.hpp"

namespace isophote {

/// Follows the measured times of submits: they shall last as long as was asked, and no dispatch so long that a watchdog
/// might kill it or an interrupt would wait for it. Never changes the image.
class WorkSize {
public:
  static constexpr uint32_t kMostWaves = 64;

  explicit WorkSize(double submitMilliseconds) : submitMilliseconds_(submitMilliseconds) {}

  /// A pool of another size: all of its slots may be in use.
  void setCapacity(uint32_t paths) { activeLimit_ = capacity_ = paths; }
  /// The steps at the end of the last render are too many for a pool at work.
  void beginRender() { steps_ = fullSteps_; }
  /// What a submit of this pipeline took.
  /// @param startsPaths  the next one may start new paths
  void follow(Pipeline pipeline, double submitMilliseconds, double longestDispatchMilliseconds, bool startsPaths);

  [[nodiscard]] uint32_t waves() const { return waves_; }             ///< of a submit of the wavefront
  [[nodiscard]] uint32_t steps() const { return steps_; }             ///< of a dispatch of the fused kernel
  [[nodiscard]] uint32_t activeLimit() const { return activeLimit_; } ///< paths in flight

private:
  double submitMilliseconds_;
  uint32_t capacity_ = 0;
  uint32_t activeLimit_ = 0;
  uint32_t waves_ = 1;
  uint32_t steps_ = 1;
  uint32_t fullSteps_ = 1; ///< as they last were while new paths started
};

} // namespace isophote
