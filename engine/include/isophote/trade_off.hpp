// What a way to render costs and what it gets wrong; which of several are worth it.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace isophote {

struct TradeOff {
  double cost = 0; ///< seconds times the relative mean square of the noise after them: constant, as noise falls so
  double biasSquare = 0; ///< relative mean square that no time removes; 0 or more
};

/// Relative RMS error, noise and bias together, after `seconds` > 0.
[[nodiscard]] double errorAfter(const TradeOff& way, double seconds);

/// Seconds to a relative RMS error; infinite where the bias alone is as large.
[[nodiscard]] double secondsToError(const TradeOff& way, double error);

/// The ways that no other beats at every time, by index, from the cheapest to the least biased: of no other are both
/// cost and bias lower or the same (of two that are alike the first is kept).
[[nodiscard]] std::vector<size_t> paretoFront(std::span<const TradeOff> ways);

} // namespace isophote
