// The error that an image shall have: when its samples suffice, and how many that will take.
#pragma once

#include <cstdint>

#include "isophote/film.hpp"
#include "isophote/interval.hpp"

namespace isophote {

struct ErrorTarget {
  double error = 0.02;      ///< relative RMS
  double confidence = 0.95; ///< of the interval that must lie below it
};

/// The image's error after some samples.
struct ErrorLook {
  double samples = 0; ///< a pixel
  ErrorEstimate error;
};

/// The error is looked at each time the samples have grown by a quarter, in whole rounds over the replicates: often
/// enough to waste little, and so seldom that the looks hardly raise the chance to stop on a lucky one.
/// @param samples  a pixel, so far
/// @return         samples at the next look
[[nodiscard]] uint64_t nextLook(uint64_t samples);

/// Whether the upper end of the error's interval lies at or below the target.
[[nodiscard]] bool reached(const ErrorTarget& target, const ErrorEstimate& error);

/// Samples a pixel at which `target` will be reached, with a 95% interval.
///
/// The upper end of the error's interval falls as samples^-1/2. That forecast errs by the scatter of the estimate now
/// and at the end, of which the samples now held are common to both; by the exponent, which Sobol points make steeper
/// and rare bright events flatter for a while; and by the next look's distance. What has never been seen (a caustic
/// before its first path) is in no forecast. How often the interval holds: docs/accuracy.md.
/// @param look  of a known error; the forecast of a target that is reached is the look itself
[[nodiscard]] Interval forecastSamples(const ErrorLook& look, const ErrorTarget& target);

/// The error after `samples` a pixel, more or fewer than the look's, with a 95% interval.
[[nodiscard]] Interval forecastError(const ErrorLook& look, double samples);

/// The upper end of the interval in an image of `pixelRatio` times as many pixels, alike in content: it lies closer to
/// the error where there are more of them.
[[nodiscard]] double upperOfLargerImage(const ErrorEstimate& error, double pixelRatio);

} // namespace isophote
