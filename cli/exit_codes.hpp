// What the process returns. Scripts rely on these numbers.
#pragma once

#include <exception>

namespace isophote::cli {

enum ExitCode : int {
  kDone = 0,
  kFailed = 1,
  kUsage = 2,
  kInvalidAsset = 3,
  kUnsupported = 4,
  kLimit = 5,
  kNoDevice = 6,
  kOutputFailed = 7,
  kBudgetEnded = 8,  ///< before the target error
  kInterrupted = 130 ///< with the work saved
};

[[nodiscard]] ExitCode exitCodeOf(const std::exception& error);

} // namespace isophote::cli
