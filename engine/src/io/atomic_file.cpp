#include "io/atomic_file.hpp"

#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "isophote/error.hpp"
#include "isophote/image.hpp"

namespace isophote {
namespace {

std::filesystem::path folderOf(const std::filesystem::path& file) {
  return file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
}

std::string reason(int error) { return std::generic_category().message(error); }

/// Makes a rename survive a power cut. File systems that cannot sync a folder answer EINVAL; there is nothing more to
/// do.
void syncFolder(const std::filesystem::path& folder) {
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return; // a folder may be writable without being readable
  const int error = fsync(descriptor) == 0 ? 0 : errno;
  close(descriptor);
  if (error != 0 && error != EINVAL) throw OutputError(folder.string() + ": " + reason(error));
}

} // namespace

namespace io {

AtomicFile::AtomicFile(std::filesystem::path target) : target_(std::move(target)) {
  checkWritable(target_);
  const std::string base = target_.string() + ".tmp." + std::to_string(getpid());
  // A name that exists may belong to a crashed process or to one of another container with the same id, so it is never
  // reused: taking it over could rename somebody's half-written file.
  constexpr int kAttempts = 100;
  for (int attempt = 0; attempt < kAttempts && descriptor_ < 0; ++attempt) {
    temporary_ = attempt == 0 ? base : base + "." + std::to_string(attempt);
    descriptor_ = open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ < 0 && errno != EEXIST) break;
  }
  if (descriptor_ < 0) throw OutputError(temporary_.string() + ": cannot create: " + reason(errno));
}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0) close(descriptor_);
  if (!temporary_.empty()) unlink(temporary_.c_str());
}

void AtomicFile::fail(const char* action) {
  if (error_ == 0) error_ = errno;
  throw OutputError(target_.string() + ": " + action + ": " + reason(error_));
}

void AtomicFile::write(const void* bytes, size_t count) {
  const char* next = static_cast<const char*>(bytes);
  while (count > 0) {
    const ssize_t written = pwrite(descriptor_, next, count, static_cast<off_t>(position_));
    if (written < 0 && errno == EINTR) continue;
    if (written == 0) errno = ENOSPC; // POSIX leaves this open; retrying could loop forever
    if (written <= 0) fail("cannot write");
    next += written;
    count -= static_cast<size_t>(written);
    position_ += static_cast<uint64_t>(written);
  }
}

void AtomicFile::commit() {
  if (error_ != 0) fail("cannot write");
  if (fsync(descriptor_) != 0) fail("cannot sync");
  const int descriptor = std::exchange(descriptor_, -1);
  if (close(descriptor) != 0) fail("cannot close");
  if (rename(temporary_.c_str(), target_.c_str()) != 0) fail("cannot rename");
  temporary_.clear();
  syncFolder(folderOf(target_));
}

} // namespace io

void writeFileAtomically(const std::filesystem::path& file, const std::string& bytes) {
  io::AtomicFile out(file);
  out.write(bytes.data(), bytes.size());
  out.commit();
}

void checkWritable(const std::filesystem::path& file) {
  if (!file.has_filename()) throw OutputError(file.string() + ": not a file name");
  const std::filesystem::path folder = folderOf(file);
  struct stat status {};
  if (stat(folder.c_str(), &status) != 0) throw OutputError(folder.string() + ": " + reason(errno));
  if (!S_ISDIR(status.st_mode)) throw OutputError(folder.string() + ": not a folder");
  if (stat(file.c_str(), &status) == 0) {
    if (S_ISDIR(status.st_mode)) throw OutputError(file.string() + ": is a folder");
  } else if (errno != ENOENT) {
    throw OutputError(file.string() + ": " + reason(errno));
  }
  // The longest name written is that of the temporary file.
  const std::string temporary = file.filename().string() + ".tmp." + std::to_string(getpid());
  const long longest = pathconf(folder.c_str(), _PC_NAME_MAX);
  if (longest > 0 && temporary.size() > static_cast<size_t>(longest)) {
    throw OutputError(
        file.string() + ": name longer than " +
        std::to_string(static_cast<size_t>(longest) - (temporary.size() - file.filename().string().size())) + " bytes");
  }
  if (access(folder.c_str(), W_OK | X_OK) != 0) throw OutputError(folder.string() + ": " + reason(errno));
}

} // namespace isophote
