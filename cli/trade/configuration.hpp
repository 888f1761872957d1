// Ways to render: the exact settings with some of them changed.
#pragma once

#include <string>
#include <vector>

#include "setting_table.hpp"

namespace isophote::cli {

struct Change {
  std::string key;
  std::string value;
  bool operator==(const Change&) const = default;
};

/// In the order of the setting table, so that equal ones compare equal.
struct Configuration {
  std::vector<Change> changes; ///< none: the exact settings

  [[nodiscard]] bool operator==(const Configuration&) const = default;
  [[nodiscard]] bool exact() const { return changes.empty(); }
  /// `key=value key=value`, or "exact".
  [[nodiscard]] std::string name() const;
  /// @throws UsageError
  [[nodiscard]] Settings settings() const;
  /// The settings' own declaration: the ledger is empty.
  [[nodiscard]] bool declaredUnbiased() const;
  /// Whether nothing but how the work is cut differs, which never changes the image.
  [[nodiscard]] bool executionOnly() const;
  /// Whether it is judged by its denoised layer. Noise and bias of that both fall with the samples, so that it is no
  /// way to render that could be compared with others at every time.
  [[nodiscard]] bool denoised() const;
  /// Both configurations' changes; nothing where they disagree on a setting, or one of them holds the other.
  [[nodiscard]] Configuration combinedWith(const Configuration& other) const;
};

/// Each value of each setting alone that differs from the exact one, as the setting table says.
/// @param asked  `key` or `key=value,value`: these settings only; empty: all that change the image
/// @throws UsageError for an unknown setting or value
[[nodiscard]] std::vector<Configuration> singleChanges(const std::vector<std::string>& asked);

} // namespace isophote::cli
