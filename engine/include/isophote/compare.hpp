// How different two images are, and whether that is more than their own noise.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "isophote/image.hpp"

namespace isophote {

/// The verdict of a statistical comparison; present where both images carry `stderr.{R,G,B}`.
struct Verdict {
  bool same = true;
  double p = 1;               ///< family-wise, over all pixel-channels and blocks of 4x4, 16x16, … pixels
  double passingFraction = 1; ///< share of pixel-channels within the critical z
  uint64_t failingBlocks = 0;
  /// Per pixel-channel, three values a pixel: the difference as deviations of a normal variable that is as improbable;
  /// 0 where an error is not known.
  std::vector<float> deviations;
  double criticalDeviation = 0; ///< beyond which one of all tests together fails
};

struct Comparison {
  double relMse = 0; ///< mean over pixels and channels of (a - b)^2 / (b^2 + e^2), e = 1% of b's mean luminance
  double rmse = 0;
  double psnr = 0;    ///< decibel, of what a display shows after the Neutral tone map; infinite for equal pictures
  double flip = 0;    ///< mean LDR-FLIP (Andersson et al. 2020) after the Neutral tone map
  double hdrFlip = 0; ///< mean HDR-FLIP (Andersson et al. 2021)
  std::optional<Verdict> verdict;
  std::vector<float> flipMap; ///< per pixel, row 0 at the top
};

/// Compares `test` with `reference`.
/// @throws UsageError where sizes differ or a colour channel is missing
[[nodiscard]] Comparison compareImages(const Image& test, const Image& reference);

} // namespace isophote
