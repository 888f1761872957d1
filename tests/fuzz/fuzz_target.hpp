// What reads bytes of strangers, as functions of those bytes. tests/fuzz/libfuzzer searches for inputs that break
// them; fuzz_test.cpp runs what was found and some deterministic damage.
#pragma once

#include <span>
#include <string>

#include "unit/gltf_asset.hpp"

namespace isophote::fuzz {

struct FuzzTarget {
  const char* name; ///< also of its folder of inputs in tests/fuzz/corpus
  /// Reads `bytes`, by way of a file in `folder` where the reader wants one.
  /// @throws Error for what it refuses: any other exception is a finding, as a crash is
  void (*read)(const test::TemporaryFolder& folder, const std::string& bytes);
};

[[nodiscard]] std::span<const FuzzTarget> fuzzTargets();

/// @return whether the bytes were accepted. Anything but an isophote::Error escapes.
bool accepts(const FuzzTarget& target, const test::TemporaryFolder& folder, const std::string& bytes);

} // namespace isophote::fuzz
