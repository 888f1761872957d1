// The image's relative RMS error with its interval, from sums over pixels.
#pragma once

#include <cstdint>

#include "isophote/film.hpp"

namespace isophote {

/// Over the pixels with a known error, with t = sum over channels of Var[mean] / (mean^2 + e^2).
struct ErrorSums {
  double luminance = 0;
  double relativeSquare = 0; ///< sum of t
  double termSquare = 0;     ///< sum of t^2
  double untrusted = 0;      ///< sum of t over the untrusted pixels
  uint64_t pixels = 0;
  uint64_t untrustedPixels = 0;
};

/// The interval holds the error that this image has, not just the expectation over seeds.
///
/// Let t estimate the pixel's expected square error s with R replicates whose means have excess kurtosis k. Then
/// E[t^2] = s^2 (1 + 2/(R-1) + k/R), t varies by s^2 (2/(R-1) + k/R), and the square of the error that the pixel has by
/// s^2 (2 + k/R). Twice the sum of t^2 exceeds both together, for any k: no normal law is assumed, and a sum that a few
/// pixels dominate gets the wide interval it deserves. The sum is positive and skewed to the right, hence log-normal.
///
/// An untrusted pixel saw a rare event about once; in the upper bound it counts kRareEventFactor times.
/// @param confidence  of the two-sided interval, in (0, 1)
[[nodiscard]] ErrorEstimate imageError(const ErrorSums& sums, double confidence);

/// The z with P(|Z| <= z) = `confidence` for a standard normal Z.
[[nodiscard]] double normalTwoSided(double confidence);

} // namespace isophote
