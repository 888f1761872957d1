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
  StoppableRender(PathTracer& tracer, const Camera& camera, Film& film, const StopRule& rule, ProgressLine& progress)
      : tracer_(tracer), camera_(camera), film_(film), rule_(rule), progress_(progress) {}

  RenderResult run() {
    uint32_t next = rule_.samples.first;
    while (next < rule_.samples.last) {
      const uint32_t end = next + passLength(next);
      const bool finished = renderPass({next, end});
      error_ = film_.error(rule_.confidence);
      if (interrupted()) return result(Outcome::Interrupted);
      if (targetReached()) return result(Outcome::Completed);
      if (!finished) return result(rule_.targetError ? Outcome::BudgetEnded : Outcome::Completed);
      next = end;
    }
    return result(rule_.targetError ? Outcome::BudgetEnded : Outcome::Completed);
  }

private:
  [[nodiscard]] uint32_t passLength(uint32_t next) const {
    const uint32_t left = rule_.samples.last - next;
    if (!rule_.targetError) return left;
    const uint32_t done = next - rule_.samples.first;
    const uint32_t rounds = std::max(1u, done / 4 / gpu::kReplicateCount);
    return std::min(left, rounds * gpu::kReplicateCount);
  }

  bool renderPass(SampleRange pass) {
    const auto onProgress = [&](const Progress& progress) {
      if (!compileSeconds_) compileSeconds_ = tracer_.statistics().compileSeconds; // done by the first pass
      if (interrupted() || timeUp()) return false;
      if (progress_.due()) showProgress(pass, progress);
      return true;
    };
    const bool finished = tracer_.render(camera_, film_, pass, onProgress);
    const RenderStatistics statistics = tracer_.statistics();
    raysBefore_ = static_cast<double>(statistics.primaryRays + statistics.bounceRays + statistics.shadowRays);
    return finished && !timeUp();
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
  [[nodiscard]] double elapsed() const { return secondsSince(start_) - compileSeconds_.value_or(0); }
  [[nodiscard]] RenderResult result(Outcome outcome) const {
    return {.outcome = outcome, .seconds = elapsed(), .error = error_};
  }

  PathTracer& tracer_;
  const Camera& camera_;
  Film& film_;
  const StopRule& rule_;
  ProgressLine& progress_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point errorAt_ = start_;
  ErrorEstimate error_;
  double raysBefore_ = 0; ///< of earlier passes
  std::optional<double> compileSeconds_;
};

} // namespace

RenderResult renderUntil(PathTracer& tracer, const Camera& camera, Film& film, const StopRule& rule,
                         ProgressLine& progress) {
  return StoppableRender(tracer, camera, film, rule, progress).run();
}

} // namespace isophote::cli
