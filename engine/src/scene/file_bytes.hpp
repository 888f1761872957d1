// Whole files into memory, with a limit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace isophote {

using Bytes = std::vector<std::byte>;

/// Reads a regular file of at most `maxBytes`; with `wantedBytes`, only so many of its first bytes.
///
/// `reportedFile` and `pointer` name the place that errors are reported for.
/// @throws SceneError where it is missing, not a regular file or unreadable; LimitError where it is too large
[[nodiscard]] Bytes readFileBytes(const std::filesystem::path& path, uint64_t maxBytes, const std::string& reportedFile,
                                  const std::string& pointer, std::optional<uint64_t> wantedBytes = std::nullopt);

} // namespace isophote
