#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <unistd.h>

#include "support/scoped_variable.hpp"

namespace isophote::test {

/// A user's cache that is empty, for one scope.
class CacheFolder {
public:
  CacheFolder() { std::filesystem::create_directories(folder_); }
  CacheFolder(const CacheFolder&) = delete;
  CacheFolder& operator=(const CacheFolder&) = delete;
  ~CacheFolder() { std::filesystem::remove_all(folder_); }

  /// Where the project keeps what is its own; drivers keep their caches beside it.
  [[nodiscard]] std::filesystem::path own() const { return folder_ / "isophote"; }
  [[nodiscard]] std::vector<std::filesystem::path> files() const {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(own())) files.push_back(entry.path());
    return files;
  }

private:
  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("isophote-cache." + std::to_string(getpid()));
  ScopedVariable variable_{"XDG_CACHE_HOME", folder_.string()};
};

} // namespace isophote::test
