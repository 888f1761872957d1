// What a pixel's replicates say of its mean: error bar and trust.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "shared/film_types.h"

namespace isophote {

struct PixelError {
  double mean = 0;
  double standardError = std::numeric_limits<double>::infinity(); ///< of the mean; unknown below two replicates
  double halfWidth95 = std::numeric_limits<double>::infinity();   ///< of the 95% interval
  double largestShare = 0; ///< of the replicate that deviates most in the sum of squared deviations; 0: no deviation
};

/// The count-weighted mean over replicates, and the unbiased variance of it for equally filled replicates:
/// sum w_r^2 (m_r - m)^2 / (1 - sum w_r^2) with w_r the replicate's share of the samples.
///
/// The interval is Student's with one degree of freedom less than replicates: what a variance estimated from so few
/// normal means needs. Where the replicates are skewed to the right its upper end lies farther out; the half-width is
/// that of the upper end, so that the lower one covers rather too much. Where a single replicate makes the variance,
/// the pixel saw a rare event about once, and the interval is widened to hold the rates that are plausible then
/// (kRareEventQuantile).
/// @param sums  the replicates' sums of one channel, @param counts  their sample counts
[[nodiscard]] PixelError pixelError(const std::array<int64_t, gpu::kReplicateCount>& sums,
                                    const std::array<uint32_t, gpu::kReplicateCount>& counts, double valuePerUnit);

/// 1 where the replicates deviate alike, 0 where one of them makes the whole variance; below 0.1, which is
/// gpu::kTrustedShare, the error bar rests on about one event.
/// @param largestShare  the largest over the channels
[[nodiscard]] double trust(double largestShare);

} // namespace isophote
