// `isophote render --plan`: what a render would take, from a short pilot.
#pragma once

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "isophote/error_target.hpp"
#include "isophote/gpu_scene.hpp"
#include "isophote/path_tracer.hpp"
#include "rendering/pace.hpp"
#include "rendering/render_options.hpp"

namespace isophote::cli {

/// A short render of a smaller image from the same view: as many pixels as fill the device's path pool with one round
/// over the replicates, for a few seconds.
struct Pilot {
  View view;
  PixelRect crop;
  ErrorLook look;
  double seconds = 0;
  double pixelRatio = 1;     ///< of the image to come over the pilot's pixels
  Interval secondsPerSample; ///< of the image to come
  RenderStatistics statistics;
};

/// @param goOn  asked now and then; false ends the pilot early
[[nodiscard]] Pilot runPilot(const Device& device, const GpuScene& scene, const RenderOptions& options,
                             const View& view, const PixelRect& crop, const std::function<bool()>& goOn);

/// One answer: samples a pixel, seconds and error at the end of a render, with 95% intervals.
struct Prospect {
  Interval samples;
  Interval seconds;
  Interval error; ///< unknown where all zero
};
[[nodiscard]] Prospect prospectOfTarget(const Pilot& pilot, const ErrorTarget& target);
[[nodiscard]] Prospect prospectOfSamples(const Pilot& pilot, double samples);
[[nodiscard]] Prospect prospectOfTime(const Pilot& pilot, double seconds);

/// Loads the scene, runs the pilot and prints the answers. @return exit code
[[nodiscard]] int runPlan(const RenderOptions& options);

} // namespace isophote::cli
