#include "scene/file_bytes.hpp"

#include <algorithm>
#include <fstream>
#include <system_error>

#include <fmt/format.h>

#include "isophote/error.hpp"

namespace isophote {

Bytes readFileBytes(const std::filesystem::path& path, uint64_t maxBytes, const std::string& reportedFile,
                    const std::string& pointer, std::optional<uint64_t> wantedBytes) {
  namespace fs = std::filesystem;
  const std::string shown = pointer.empty() ? "" : fmt::format(" ({})", path.string());
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  if (status.type() == fs::file_type::not_found) throw SceneError(reportedFile, pointer, "no such file" + shown);
  if (status.type() != fs::file_type::regular) throw SceneError(reportedFile, pointer, "not a regular file" + shown);
  const uint64_t fileBytes = fs::file_size(path, code);
  if (code) throw SceneError(reportedFile, pointer, "its size cannot be read: " + code.message() + shown);
  const uint64_t size = std::min(fileBytes, wantedBytes.value_or(fileBytes));
  if (size > maxBytes) {
    throw LimitError(fmt::format("{}: {} bytes to read{}, the limit is {}", reportedFile, size, shown, maxBytes));
  }
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw SceneError(reportedFile, pointer, "cannot be opened for reading" + shown);
  Bytes bytes(size);
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  if (static_cast<uint64_t>(stream.gcount()) != size) {
    throw SceneError(reportedFile, pointer, "ended while it was read" + shown);
  }
  return bytes;
}

} // namespace isophote
