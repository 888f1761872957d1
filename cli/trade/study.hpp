// What each setting costs and gains on one scene: the measurements, and how they are made.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "trade/measurement.hpp"
#include "trade/workbench.hpp"

namespace isophote::cli {

struct Reference {
  std::string source; ///< a file, or "rendered"
  Image image;
  uint32_t samples = 0; ///< of one rendered here
  double seconds = 0;
  double square = 0; ///< relative mean square of its own error
  double untrustedShare = 0;
  /// Its error is below what the mean of all runs of one configuration is left with, and below a tenth: pixels relative
  /// to worse values mean nothing.
  bool goodEnough = false;
};

/// The fastest way to an error, and what fresh seeds say of it.
struct Recommendation {
  std::string purpose;
  double targetError = 0;
  size_t measurement = 0;
  uint32_t samples = 0;
  double seconds = 0; ///< forecast
  // The confirmation, of fewer samples where the budget did not allow them all.
  uint32_t confirmedSamples = 0;
  double forecastError = 0; ///< after confirmedSamples
  double forecastSeconds = 0;
  ErrorSplit found;
  Interval foundSeconds;
  [[nodiscard]] bool tried() const { return found.runs > 0; }
  /// No more than a quarter above the forecast, and not above it beyond doubt.
  [[nodiscard]] bool confirmed() const {
    const double forecast = forecastError * forecastError;
    return tried() && found.totalSquare.lower <= forecast && found.totalSquare.value <= 1.25 * 1.25 * forecast;
  }
};

struct StudyPlan {
  double seconds = 120; ///< for everything
  std::vector<std::string> settings;
  std::optional<Image> reference; ///< with error bars
  std::string referenceFile;
};

struct Study {
  Reference reference;
  uint32_t samplesPerRun = 0;
  std::vector<Measurement> measurements; ///< the exact settings first
  std::vector<size_t> front;             ///< of those that were measured
  std::vector<Recommendation> recommendations;
  double seconds = 0;
  double compileSeconds = 0;
  bool interrupted = false;

  [[nodiscard]] const Measurement& exact() const { return measurements.front(); }
  /// How many configurations were measured: as many chances to see a bias that is not there.
  [[nodiscard]] size_t measuredCount() const;
  [[nodiscard]] TradeOff tradeOff(size_t measurement) const { return tradeOffOf(measurements[measurement], exact()); }
  [[nodiscard]] bool biasSeen(const Measurement& measurement) const {
    return biasIsSeen(measurement.split, measuredCount(), reference.goodEnough);
  }
};

/// Called between renders and now and then within one: what is being done.
using StudyProgress = std::function<void(const std::string& stage)>;

/// Measures until the plan's time is up, or the user interrupts; what was measured until then is returned.
/// @param elapsed  seconds since the command began
[[nodiscard]] Study runStudy(Workbench& bench, const StudyPlan& plan, const std::function<double()>& elapsed,
                             const StudyProgress& progress);

/// Chooses, for draft, balanced and final, the fastest way to 20%, 5% and 1%; of those whose cost is below
/// that of the exact settings with all of its interval. Each change of a setting must save a twentieth of the time, and
/// the last way must be unbiased.
[[nodiscard]] std::vector<Recommendation> recommend(const Study& study);

} // namespace isophote::cli
