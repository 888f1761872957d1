// What is known of one configuration on one scene.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "isophote/error_split.hpp"
#include "isophote/trade_off.hpp"
#include "trade/configuration.hpp"

namespace isophote::cli {

struct Run {
  uint32_t round = 0; ///< runs of one round were made one after the other
  uint64_t seed = 0;
  uint32_t samples = 0;
  double seconds = 0;
  double noiseSquare = 0; ///< relative mean square, by the run's own error bars
};

enum class MeasurementState {
  Planned,
  Measured,
  NoEffect, ///< the image was the same to the last bit
  Refused   ///< the settings do not go together
};

struct Measurement {
  Configuration configuration;
  bool declaredUnbiased = true;
  MeasurementState state = MeasurementState::Planned;
  std::string reason; ///< of a refusal
  std::vector<Run> runs;
  std::optional<ErrorSplitter> splitter; ///< of the runs
  ErrorSplit split;

  [[nodiscard]] bool measured() const { return state == MeasurementState::Measured && runs.size() >= 2; }
  [[nodiscard]] Interval seconds() const; ///< of one run
  [[nodiscard]] uint32_t samples() const { return runs.empty() ? 0 : runs.front().samples; }
};

/// Seconds, noise (relative mean square) and their product, over those of `base`; runs are paired by round.
struct Price {
  Interval seconds;
  Interval noise;
  Interval cost;
};
[[nodiscard]] Price priceOf(const Measurement& measurement, const Measurement& base);

/// The cost is that of `base` times what runs side by side say of the ratio. Bias of settings that declare none counts
/// as none; of others its upper bound does, so that one too small to be seen is not taken for nothing.
[[nodiscard]] TradeOff tradeOffOf(const Measurement& measurement, const Measurement& base);

/// Whether noise alone would make one of `tests` configurations look so biased in less than 1% of studies: its pixels,
/// or all of them together.
/// @param pixels  false where the reference is too noisy for its pixels to say anything
[[nodiscard]] bool biasIsSeen(const ErrorSplit& split, size_t tests, bool pixels = true);

} // namespace isophote::cli
