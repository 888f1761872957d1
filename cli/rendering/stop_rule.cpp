#include "rendering/stop_rule.hpp"

#include <algorithm>
#include <chrono>

#include "rendering/interrupt.hpp"
#include "rendering/pace.hpp"

namespace isophote::cli {
namespace {

using Clock = std::chrono::steady_clock;

class StoppableRender {
public:
  StoppableRender(PathTracer& tracer, const Camera& camera, Film& film, const StopRule& rule, ProgressLine& progress,
                  CheckpointKeeper* checkpoints, const AdaptivePlan* adaptive)
      : tracer_(tracer), camera_(camera), film_(film), rule_(rule), progress_(progress), checkpoints_(checkpoints),
        adaptive_(adaptive) {}

  RenderResult run() {
    left_ = rule_.samples;
    if (checkpoints_ != nullptr) {
      const RenderStart start = checkpoints_->start(film_, rule_.samples);
      left_ = start.left;
      secondsBefore_ = start.seconds;
    }
    if (adaptive_ != nullptr) secondsBefore_ += adaptive_->pilotSeconds;
    const Outcome outcome = renderPasses();
    if (checkpoints_ != nullptr) checkpoints_->save(film_, left_, elapsed());
    return {.outcome = outcome, .seconds = elapsed(), .error = error_, .looks = std::move(looks_)};
  }

private:
  Outcome renderPasses() {
    const Outcome ended = rule_.target ? Outcome::BudgetEnded : Outcome::Completed;
    uint32_t next = rule_.samples.first;
    while (next < rule_.samples.last) {
      const uint32_t end = passEnd(next);
      if (left_.first < end) {
        const bool finished = renderPass({std::max(next, left_.first), end, left_.begun});
        error_ = film_.error(rule_.confidence);
        if (interrupted()) return Outcome::Interrupted;
        if (!finished) return targetReached() ? Outcome::Completed : ended;
        look(end);
        if (targetReached()) return Outcome::Completed;
      } else if (left_.first == end) { // where a checkpoint was written between passes
        error_ = film_.error(rule_.confidence);
        look(end);
        if (targetReached()) return Outcome::Completed;
      }
      next = end;
    }
    if (!error_.known) error_ = film_.error(rule_.confidence); // nothing was left to render
    return ended;
  }

  [[nodiscard]] uint32_t passEnd(uint32_t next) const {
    if (!rule_.target && adaptive_ == nullptr) return rule_.samples.last;
    const uint64_t end = rule_.samples.first + nextLook(next - rule_.samples.first);
    return static_cast<uint32_t>(std::min<uint64_t>(end, rule_.samples.last));
  }

  void look(uint32_t end) {
    if (!rule_.target) return;
    Look look{.samples = samplesPerPixel(end - rule_.samples.first), .seconds = elapsed(), .error = error_};
    if (error_.known) {
      look.samplesToTarget = forecastSamples({look.samples, error_}, rule_.errorTarget());
      look.secondsToTarget = secondsAt(look.samplesToTarget, look.samples);
    }
    looks_.push_back(look);
  }

  /// In the mean, where a pixel of the first class has `samples`.
  [[nodiscard]] double samplesPerPixel(double samples) const {
    return adaptive_ != nullptr ? samples * adaptive_->allocation.samplesPerPixel : samples;
  }

  /// Of rendering, when `samples` a pixel are done, of which `done` are now.
  [[nodiscard]] Interval secondsAt(const Interval& samples, double done) const {
    const double now = elapsed();
    if (!(samples.value > done) || !pace_.known()) return {now, now, now};
    const double missing = samples.value - done;
    const Interval more = {missing, std::clamp(samples.lower - done, 0.01 * missing, missing), samples.upper - done};
    const Interval seconds = product(more, pace_.secondsPerSample());
    return {now + seconds.value, now + seconds.lower, now + seconds.upper};
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
      compileSeconds_ = tracer_.statistics().compileSeconds - compiledBefore_; // at the beginning of passes
      if (interrupted() || timeUp() || (checkpoints_ != nullptr && checkpoints_->due())) return false;
      if (progress_.due()) showProgress(pass, progress);
      return true;
    };
    const double begun = elapsed();
    const bool finished = adaptive_ != nullptr
                              ? renderAllocated(tracer_, camera_, film_, pass, adaptive_->allocation, onProgress)
                              : tracer_.render(camera_, film_, pass, onProgress);
    if (finished && pass.begun == 0) pace_.add(samplesPerPixel(pass.last - pass.first), elapsed() - begun);
    const RenderStatistics statistics = tracer_.statistics();
    raysBefore_ = static_cast<double>(statistics.primaryRays + statistics.bounceRays + statistics.shadowRays);
    return finished;
  }

  void showProgress(SampleRange pass, const Progress& progress) {
    const double done = pass.first - rule_.samples.first + progress.fraction * (pass.last - pass.first);
    if (secondsSince(errorAt_) > std::max(1.0, kErrorPause * errorSeconds_)) { // costs a pass over the film
      const Clock::time_point begun = Clock::now();
      error_ = film_.error(rule_.confidence);
      errorAt_ = Clock::now();
      errorSeconds_ = secondsSince(begun);
    }
    RenderState state{.seconds = elapsed(), .rays = raysBefore_ + static_cast<double>(progress.rays), .error = error_};
    state.fraction = done / (rule_.samples.last - rule_.samples.first);
    if (rule_.seconds) state.fraction = std::max(state.fraction, elapsed() / *rule_.seconds);
    if (rule_.target && error_.known && done > 0) {
      const double held = samplesPerPixel(done);
      const Interval samples = forecastSamples({held, error_}, rule_.errorTarget());
      const double share = std::min(held / samples.value, 0.99);
      if (share > state.fraction) {
        state.fraction = share;
        if (pace_.known()) state.ends = secondsAt(samples, held);
      }
    }
    progress_.show(state);
  }

  static constexpr double kErrorPause = 50; ///< between two errors for the progress line, in times of what one takes

  [[nodiscard]] bool targetReached() const { return rule_.target && reached(rule_.errorTarget(), error_); }
  [[nodiscard]] bool timeUp() const { return rule_.seconds && elapsed() >= *rule_.seconds; }
  static double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
  }
  /// Of rendering: without the compilation of kernels, which the first pass begins with.
  [[nodiscard]] double elapsed() const { return secondsBefore_ + secondsSince(start_) - compileSeconds_; }

  PathTracer& tracer_;
  const Camera& camera_;
  Film& film_;
  const StopRule& rule_;
  ProgressLine& progress_;
  CheckpointKeeper* checkpoints_;
  const AdaptivePlan* adaptive_;
  SampleRange left_;         ///< of all that was asked for
  double secondsBefore_ = 0; ///< of a render that this one goes on with
  Clock::time_point start_ = Clock::now();
  Clock::time_point errorAt_ = start_;
  double errorSeconds_ = 0; ///< that it took then
  ErrorEstimate error_;
  std::vector<Look> looks_;
  Pace pace_;
  double raysBefore_ = 0; ///< of earlier passes
  double compiledBefore_ = tracer_.statistics().compileSeconds;
  double compileSeconds_ = 0;
};

} // namespace

RenderResult renderUntil(PathTracer& tracer, const Camera& camera, Film& film, const StopRule& rule,
                         ProgressLine& progress, CheckpointKeeper* checkpoints, const AdaptivePlan* adaptive) {
  return StoppableRender(tracer, camera, film, rule, progress, checkpoints, adaptive).run();
}

} // namespace isophote::cli
