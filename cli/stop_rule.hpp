// When a render ends.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "checkpoint_keeper.hpp"
#include "isophote/path_tracer.hpp"
#include "progress_line.hpp"

namespace isophote::cli {

struct StopRule {
  SampleRange samples;               ///< at most these
  std::optional<double> targetError; ///< relative RMS error; reached when its interval lies below
  double confidence = 0.95;          ///< of that interval
  std::optional<double> seconds;     ///< of rendering, compilation excluded
};

enum class Outcome {
  Completed,   ///< all samples, the target error, or the time where no target was given
  BudgetEnded, ///< samples or time, before the target error
  Interrupted
};

struct RenderResult {
  Outcome outcome = Outcome::Completed;
  double seconds = 0;
  ErrorEstimate error; ///< at the end
};

/// Renders until the rule or the user says stop.
///
/// With a target error, samples are taken in passes of whole rounds over the replicates, each a quarter of what there
/// is, and the error is looked at between passes only. So where a render stops depends on the scene and seed, not on
/// the machine's speed, and every replicate holds the same number of samples. A render that goes on from a checkpoint
/// stops where it would have without the break.
/// @param checkpoints  none are kept where null
[[nodiscard]] RenderResult renderUntil(PathTracer& tracer, const Camera& camera, Film& film, const StopRule& rule,
                                       ProgressLine& progress, CheckpointKeeper* checkpoints = nullptr);

} // namespace isophote::cli
