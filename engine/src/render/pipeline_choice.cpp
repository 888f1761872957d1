#include "render/pipeline_choice.hpp"

namespace isophote {
namespace {

// Submits of each that find their length, and then those that count.
constexpr uint32_t kWarmUp = 8;
constexpr uint32_t kMeasured = 12;

} // namespace

PipelineChoice::PipelineChoice(Pipeline asked, Pipeline first, bool mayRace, double compileShare)
    : next_(asked == Pipeline::Auto ? first : asked),
      stage_(asked == Pipeline::Auto && mayRace ? Stage::Alone : Stage::Settled), compileShare_(compileShare) {}

Pipeline PipelineChoice::next() const { return next_; }

void PipelineChoice::add(uint64_t rays, double milliseconds) {
  const Pipeline other = next_ == Pipeline::Fused ? Pipeline::Wavefront : Pipeline::Fused;
  if (stage_ == Stage::Alone) {
    (used_ ? aloneMilliseconds_ : compileMilliseconds_) += milliseconds;
    used_ = true;
    if (aloneMilliseconds_ * compileShare_ < compileMilliseconds_) return;
    stage_ = Stage::Race;
    next_ = other;
    return;
  }
  if (stage_ == Stage::Settled) return;
  Run& current = run(next_);
  if (++current.submits > kWarmUp) current.speeds.add(rays, milliseconds);
  const Run& rival = run(other);
  const bool finished = current.speeds.count() >= kMeasured && rival.speeds.count() >= kMeasured;
  if (!finished || rival.speeds.median() > current.speeds.median()) next_ = other;
  if (finished) stage_ = Stage::Settled;
}

} // namespace isophote
