// When a render ends.
#pragma once

#include <optional>
#include <vector>

#include "isophote/error_target.hpp"
#include "isophote/path_tracer.hpp"
#include "rendering/adaptive.hpp"
#include "rendering/checkpoint_keeper.hpp"
#include "rendering/progress_line.hpp"

namespace isophote::cli {

struct StopRule {
  SampleRange samples;           ///< at most these
  double confidence = 0.95;      ///< of the interval of the error
  std::optional<double> target;  ///< relative RMS error; reached when its interval lies below
  std::optional<double> seconds; ///< of rendering, compilation excluded

  [[nodiscard]] ErrorTarget errorTarget() const { return {.error = *target, .confidence = confidence}; }
};

/// What was known of the error at one time.
struct Look {
  double samples = 0; ///< a pixel, in the mean
  double seconds = 0; ///< of rendering
  ErrorEstimate error;
  Interval samplesToTarget; ///< forecast then, with 95% intervals
  Interval secondsToTarget; ///< from the beginning
};

enum class Outcome {
  Completed,   ///< all samples, the target error, or the time where no target was given
  BudgetEnded, ///< samples or time, before the target error
  Interrupted
};

struct RenderResult {
  Outcome outcome = Outcome::Completed;
  double seconds = 0;
  ErrorEstimate error;     ///< at the end
  std::vector<Look> looks; ///< where there is a target error
};

/// Renders until the rule or the user says stop.
///
/// With a target error, samples are taken in passes from look to look (nextLook), and the error is looked at between
/// passes only. So where a render stops depends on the scene and seed, not on the machine's speed, and every replicate
/// holds the same number of samples. A render that goes on from a checkpoint stops where it would have without the
/// break.
/// @param checkpoints  none are kept where null
/// @param adaptive     shares the samples out, of which the rule's are those of a pixel of the first class, less the
/// pilot
[[nodiscard]] RenderResult renderUntil(PathTracer& tracer, const Camera& camera, Film& film, const StopRule& rule,
                                       ProgressLine& progress, CheckpointKeeper* checkpoints = nullptr,
                                       const AdaptivePlan* adaptive = nullptr);

} // namespace isophote::cli
