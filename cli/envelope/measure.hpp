// The error of one image against the exact answer, with its error bar.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>

#include "isophote/device.hpp"
#include "isophote/scene.hpp"
#include "isophote/settings.hpp"

namespace isophote::envelope {

/// A scene whose image is known.
struct Case {
  Scene scene;
  Camera camera;
  uint32_t width = 8;
  uint32_t height = 8;
  PixelRect crop = {}; ///< empty: the full image
  EstimatorSettings estimator{.filter = PixelFilter::Box};
  double exact = 1;            ///< the mean of green over all pixels
  double scale = 0;            ///< what errors are relative to; 0: `exact`
  uint32_t fewestSamples = 64; ///< a pixel
  uint32_t mostSamples = 1 << 14;
};

/// How hard to look.
struct Effort {
  double halfWidth = 4e-4;                          ///< relative; of the error bar that is good enough
  uint32_t divideBy = 1;                            ///< fewer samples at most
  std::function<bool()> goOn = [] { return true; }; ///< asked between submits; false ends the measurement
};

/// The relative error of an image's mean, and the half-width of its 95% interval. Where all samples were alike the
/// interval is a point: an event that none of them saw is not in it.
struct Point {
  double value = 0;
  double error = 0;
  double halfWidth = 0;
  uint64_t samples = 0; ///< a pixel
  double seconds = 0;
  std::string failure = {}; ///< why there is no error to state, or what was dropped

  /// What the error is below, with 97.5% confidence.
  [[nodiscard]] double bound() const {
    return failure.empty() ? std::abs(error) + halfWidth : std::numeric_limits<double>::infinity();
  }
};

/// Renders with four times the samples until the error bar is below the effort's, below a fifth of the error, or the
/// samples are those at most. An exception, or a sample that was dropped or changed, is the point's failure.
[[nodiscard]] Point measure(const Device& device, const Case& c, double value, const Effort& effort);

} // namespace isophote::envelope
