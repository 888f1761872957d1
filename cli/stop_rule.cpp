#include "stop_rule.hpp"

#include <algorithm>
#include <chrono>

#include "interrupt.hpp"
#include "shared/film_types.h"

namespace isophote::cli {
namespace {

using Clock = std::chrono::steady_clock;

class StoppableRender {
public:
  StoppableRender(PathTracer& tracer, const Camera& camera, Film& film, const StopRule& rule, ProgressLine& progress,
                  CheckpointKeeper* checkpoints)
      : tracer_(tracer), camera_(camera), film_(film), rule_(rule), progress_(progress), checkpoints_(checkpoints) {}

  RenderResult run() {
    left_ = rule_.samples;
    if (checkpoints_ != nullptr) {
      const RenderStart start = checkpoints_->start(film_, rule_.samples);
      left_ = start.left;
      secondsBefore_ = start.seconds;
    }
    const Outcome outcome = renderPasses();
    if (checkpoints_ != nullptr) checkpoints_->save(film_, left_, elapsed());
    return {.outcome = outcome, .seconds = elapsed(), .error = error_};
  }

private:
  Outcome renderPasses() {
    const Outcome ended = rule_.targetError ? Outcome::BudgetEnded : Outcome::Completed;
    uint32_t next = rule_.samples.first;
    while (next < rule_.samples.last) {
      const uint32_t end = next + passLength(next);
      if (left_.first < end) {
        const bool finished = renderPass({std::max(next, left_.first), end, left_.begun});
        error_ = film_.error(rule_.confidence);
        if (interrupted()) return Outcome::Interrupted;
        if (targetReached()) return Outcome::Completed;
        if (!finished) return ended;
      } else if (left_.first == end) { // where a checkpoint was written between passes
        error_ = film_.error(rule_.confidence);
        if (targetReached()) return Outcome::Completed;
      }
      next = end;
    }
    if (!error_.known) error_ = film_.error(rule_.confidence); // nothing was left to render
    return ended;
  }

  [[nodiscard]] uint32_t passLength(uint32_t next) const {
    const uint32_t left = rule_.samples.last - next;
    if (!rule_.targetError) return left;
    const uint32_t done = next - rule_.samples.first;
    const uint32_t rounds = std::max(1u, done / 4 / gpu::kReplicateCount);
    return std::min(left, rounds * gpu::kReplicateCount);
  }

  /// Returns false where the time or the user ended it.
  bool renderPass(SampleRange pass) {
    while (!renderUntilCheckpoint(pass)) {
      left_ = {tracer_.left().first, rule_.samples.last, tracer_.left().begun};
      if (interrupted() || timeUp()) return false;
      checkpoints_->save(film_, left_, elapsed());
      pass = tracer_.left();
    }
    left_ = {pass.last, rule_.samples.last};
    return !timeUp();
  }

  bool renderUntilCheckpoint(SampleRange pass) {
    const auto onProgress = [&](const Progress& progress) {
      if (!compileSeconds_) compileSeconds_ = tracer_.statistics().compileSeconds; // done by the first pass
      if (interrupted() || timeUp() || (checkpoints_ != nullptr && checkpoints_->due())) return false;
      if (progress_.due()) showProgress(pass, progress);
      return true;
    };
    const bool finished = tracer_.render(camera_, film_, pass, onProgress);
    const RenderStatistics statistics = tracer_.statistics();
    raysBefore_ = static_cast<double>(statistics.primaryRays + statistics.bounceRays + statistics.shadowRays);
    return finished;
  }

  void showProgress(SampleRange pass, const Progress& progress) {
    const double done = pass.first - rule_.samples.first + progress.fraction * (pass.last - pass.first);
    double fraction = done / (rule_.samples.last - rule_.samples.first);
    if (rule_.seconds) fraction = std::max(fraction, elapsed() / *rule_.seconds);
    if (secondsSince(errorAt_) > 1) { // costs a pass over the film
      error_ = film_.error(rule_.confidence);
      errorAt_ = Clock::now();
    }
    // Errors fall as the square root of the work.
    if (rule_.targetError && error_.known) {
      const double share = *rule_.targetError / std::max(error_.upper, *rule_.targetError);
      fraction = std::max(fraction, std::min(share * share, 0.99));
    }
    progress_.show({.fraction = fraction,
                    .seconds = elapsed(),
                    .rays = raysBefore_ + static_cast<double>(progress.rays),
                    .error = error_});
  }

  [[nodiscard]] bool targetReached() const {
    return rule_.targetError && error_.known && error_.upper <= *rule_.targetError;
  }
  [[nodiscard]] bool timeUp() const { return rule_.seconds && elapsed() >= *rule_.seconds; }
  static double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
  }
  /// Of rendering: without the compilation of kernels, which the first pass begins with.
  [[nodiscard]] double elapsed() const { return secondsBefore_ + secondsSince(start_) - compileSeconds_.value_or(0); }

  PathTracer& tracer_;
  const Camera& camera_;
  Film& film_;
  const StopRule& rule_;
  ProgressLine& progress_;
  CheckpointKeeper* checkpoints_;
  SampleRange left_;         ///< of all that was asked for
  double secondsBefore_ = 0; ///< of a render that this one goes on with
  Clock::time_point start_ = Clock::now();
  Clock::time_point errorAt_ = start_;
  ErrorEstimate error_;
  double raysBefore_ = 0; ///< of earlier passes
  std::optional<double> compileSeconds_;
};

} // namespace

RenderResult renderUntil(PathTracer& tracer, const Camera& camera, Film& film, const StopRule& rule,
                         ProgressLine& progress, CheckpointKeeper* checkpoints) {
  return StoppableRender(tracer, camera, film, rule, progress, checkpoints).run();
}

} // namespace isophote::cli
