// A file that appears under its name only when it is complete and on disk.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

namespace isophote::io {

/// Collects bytes in `NAME.tmp.PID` (`.1`, `.2`… appended where that exists) beside the target; commit() syncs and
/// renames. Without commit() the temporary file is removed and whatever stood under the target's name is untouched.
class AtomicFile {
public:
  /// @throws OutputError where the temporary file cannot be made
  explicit AtomicFile(std::filesystem::path target);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();

  /// Writes at the current position. @throws OutputError
  void write(const void* bytes, size_t count);
  void seek(uint64_t position) { position_ = position; }
  [[nodiscard]] uint64_t position() const { return position_; }

  /// Syncs the file, closes it, renames it over the target and syncs the folder.
  /// A write that failed earlier, even one whose exception was swallowed on the way, is thrown again here.
  /// @throws OutputError
  void commit();

private:
  [[noreturn]] void fail(const char* action);

  std::filesystem::path target_;
  std::filesystem::path temporary_;
  uint64_t position_ = 0;
  int descriptor_ = -1;
  int error_ = 0; ///< errno of the first failure, 0 while all went well
};

} // namespace isophote::io
