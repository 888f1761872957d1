// Which pipeline the next submit uses, where that is left to measurement.
#pragma once

#include <array>
#include <cstdint>

#include "isophote/settings.hpp"
#include "render/submit_speeds.hpp"

namespace isophote {

/// Wavefront and fused kernel give the same image, bit for bit, and a submit of one can follow a submit of the other.
/// So the two can race on the render's own samples: one begins; once it has worked long enough for the compilation of
/// its rival to be a small part of the whole, they take turns; the one whose median submit traced more rays in its time
/// stays.
class PipelineChoice {
public:
  /// @param asked         Wavefront or Fused: there is nothing to choose
  /// @param first         that Auto begins with
  /// @param mayRace       else Auto stays with it
  /// @param compileShare  of the time before the race, that the rival's compilation may take
  PipelineChoice(Pipeline asked, Pipeline first, bool mayRace, double compileShare);

  [[nodiscard]] Pipeline next() const;
  [[nodiscard]] bool isSettled() const { return stage_ == Stage::Settled; }
  [[nodiscard]] bool isRacing() const { return stage_ == Stage::Race; }
  /// Making the kernels of next() took so long; the rival's are taken to take as long.
  void addCompilation(double milliseconds) { compileMilliseconds_ += milliseconds; }
  /// What a submit of next() did. The first one counts as compilation: llvmpipe compiles what is used.
  void add(uint64_t rays, double milliseconds);

private:
  enum class Stage : uint32_t { Alone, Race, Settled };
  struct Run {
    uint32_t submits = 0;
    SubmitSpeeds speeds; ///< after those that warm up
  };
  [[nodiscard]] Run& run(Pipeline pipeline) { return runs_[static_cast<size_t>(pipeline)]; }

  Pipeline next_;
  Stage stage_;
  double compileShare_;
  bool used_ = false;
  double compileMilliseconds_ = 0;
  double aloneMilliseconds_ = 0;
  std::array<Run, 2> runs_; ///< in the race, by Pipeline
};

} // namespace isophote
