// How often the error bars of images hold the truth.
#pragma once

#include <cstdint>

#include "isophote/image.hpp"

namespace isophote {

/// Over pixels and channels.
struct Coverage {
  uint64_t values = 0;
  uint64_t covered = 0;       ///< truth within mean +- ci95
  uint64_t trustedValues = 0; ///< trust.Y at least 0.1
  uint64_t trustedCovered = 0;
  uint64_t missedAbove = 0; ///< of those not covered, the ones whose truth is brighter
  uint64_t missedBlind = 0; ///< likewise, that report no error at all: nothing was seen to vary

  [[nodiscard]] double coveredShare() const {
    return values > 0 ? static_cast<double>(covered) / static_cast<double>(values) : 0;
  }
  /// What is asked of 95% intervals: they hold the truth of 93% to 97% of the values.
  [[nodiscard]] bool calibrated() const { return coveredShare() >= 0.93 && coveredShare() <= 0.97; }
};

/// Counts one image, with its error bars, against the truth.
/// @param truth  R, G, B of the same size; its own ci95 channels, where it has them, widen the intervals
/// @throws UsageError where a channel is missing or sizes differ
void addCoverage(const Image& image, const Image& truth, Coverage& coverage);

} // namespace isophote
