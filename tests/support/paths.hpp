// Where tests find files.
#pragma once

#include <filesystem>
#include <optional>

namespace isophote::test {

/// The project's own scenes.
inline std::filesystem::path assetsFolder() { return std::filesystem::path(ISOPHOTE_SOURCE_DIR) / "assets"; }

/// The sample models beside the checkout (`../shared`), where present. Tests that need them skip, with that reason,
/// elsewhere.
inline std::optional<std::filesystem::path> sharedFolder() {
  const auto folder = std::filesystem::path(ISOPHOTE_SOURCE_DIR).parent_path() / "shared";
  if (std::filesystem::is_directory(folder)) return folder;
  return std::nullopt;
}

} // namespace isophote::test
