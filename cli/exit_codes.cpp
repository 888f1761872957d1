#include "exit_codes.hpp"

#include <new>

#include "isophote/error.hpp"

namespace isophote::cli {

ExitCode exitCodeOf(const std::exception& error) {
  if (dynamic_cast<const UsageError*>(&error) != nullptr) return kUsage;
  if (dynamic_cast<const UnsupportedError*>(&error) != nullptr) return kUnsupported; // is a SceneError too
  if (dynamic_cast<const SceneError*>(&error) != nullptr) return kInvalidAsset;
  if (dynamic_cast<const LimitError*>(&error) != nullptr) return kLimit;
  if (dynamic_cast<const DeviceError*>(&error) != nullptr) return kNoDevice;
  if (dynamic_cast<const OutputError*>(&error) != nullptr) return kOutputFailed;
  if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr) return kLimit;
  return kFailed;
}

} // namespace isophote::cli
