#include <csignal>
#include <cstdlib>

#include <sys/resource.h>
#include <sys/wait.h>

#include "io/atomic_file.hpp"
#include "isophote/error.hpp"
#include "unit/io_fixture.hpp"

namespace isophote {
namespace {

using test::noiseImage;
using test::readBytes;
using test::writeBytes;

/// Makes every write beyond `bytes` of a file fail with EFBIG, as a full disk does with ENOSPC.
class FileSizeLimit {
public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

private:
  rlimit before_{};
  void (*handler_)(int);
};

class AtomicWrite : public test::InTemporaryFolder {};

TEST_F(AtomicWrite, ReplacesAFileAndLeavesNothingElse) {
  writeFileAtomically(path("a.json"), "one");
  writeFileAtomically(path("a.json"), "");
  EXPECT_EQ(readBytes(path("a.json")), "");
  writeFileAtomically(path("a.json"), "two");
  EXPECT_EQ(readBytes(path("a.json")), "two");
  EXPECT_EQ(fileCount(), 1u);
}

TEST_F(AtomicWrite, KeepsThePreviousFileWhenTheDiskIsFull) {
  writeBytes(path("a.exr"), "previous");
  writeBytes(path("a.png"), "previous");
  writeBytes(path("a.json"), "previous");
  const Image image = noiseImage(64, 64, {"R", "G", "B"});
  // 1 fails in the header, the last ones in the pixels and in the table of offsets that a destructor writes.
  for (const rlim_t bytes : {1, 300, 1000, 20000, 40000}) {
    const FileSizeLimit limit(bytes);
    EXPECT_THROW(writeExr(path("a.exr"), image), OutputError) << bytes;
    if (bytes <= 1000) {
      EXPECT_THROW(writePng(path("a.png"), image, 0, ToneMap::Srgb), OutputError) << bytes;
    }
    EXPECT_THROW(writeFileAtomically(path("a.json"), std::string(50000, 'x')), OutputError) << bytes;
  }
  for (const char* name : {"a.exr", "a.png", "a.json"}) EXPECT_EQ(readBytes(path(name)), "previous") << name;
  EXPECT_EQ(fileCount(), 3u);
}

TEST_F(AtomicWrite, FailsAtEverySizeBelowTheWholeFile) {
  const Image image = noiseImage(9, 40, {"R"});
  writeExr(path("whole.exr"), image);
  const auto whole = std::filesystem::file_size(path("whole.exr"));
  for (rlim_t bytes = 0; bytes < whole; bytes += 37) {
    const FileSizeLimit limit(bytes);
    EXPECT_THROW(writeExr(path("a.exr"), image), OutputError) << bytes << " of " << whole;
  }
  EXPECT_EQ(fileCount(), 1u);
}

// OpenEXR writes its table of offsets in a destructor, which swallows exceptions.
TEST_F(AtomicWrite, ThrowsASwallowedFailureAgainAtTheEnd) {
  writeBytes(path("a"), "previous");
  {
    io::AtomicFile file(path("a"));
    file.write("begin", 5);
    {
      const FileSizeLimit limit(8);
      EXPECT_THROW(file.write("too long", 8), OutputError);
    }
    file.seek(0);
    file.write("again", 5);
    EXPECT_THROW(file.commit(), OutputError);
  }
  EXPECT_EQ(readBytes(path("a")), "previous");
  EXPECT_EQ(fileCount(), 1u);
}

TEST_F(AtomicWrite, NeverTakesOverAnothersTemporaryFile) {
  const std::string other = "a.json.tmp." + std::to_string(getpid());
  writeBytes(path(other), "half written");
  writeFileAtomically(path("a.json"), "whole");
  EXPECT_EQ(readBytes(path("a.json")), "whole");
  EXPECT_EQ(readBytes(path(other)), "half written");
  EXPECT_EQ(fileCount(), 2u);
}

TEST_F(AtomicWrite, HandlesSpacesAndNonAsciiNames) {
  const auto name = path("größe über 中 文.json");
  writeFileAtomically(name, "x");
  EXPECT_EQ(readBytes(name), "x");
}

TEST_F(AtomicWrite, SaysBeforehandWhatCannotBeWritten) {
  std::filesystem::create_directory(path("folder"));
  writeBytes(path("file"), "x");
  EXPECT_NO_THROW(checkWritable(path("new.exr")));
  EXPECT_NO_THROW(checkWritable(path("file")));
  EXPECT_NO_THROW(checkWritable("relative.exr"));
  for (const auto& bad : {path("absent") / "a.exr", path("folder"), path("file") / "a.exr", path("folder") / "",
                          std::filesystem::path(""), path(std::string(256, 'x')), path(std::string(250, 'x'))}) {
    EXPECT_THROW(checkWritable(bad), OutputError) << bad;
    EXPECT_THROW(writeFileAtomically(bad, "x"), OutputError) << bad;
  }
  EXPECT_EQ(fileCount(), 2u);
}

TEST_F(AtomicWrite, RefusesAReadOnlyFolder) {
  if (geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  std::filesystem::create_directory(path("folder"));
  std::filesystem::permissions(path("folder"), std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  EXPECT_THROW(checkWritable(path("folder") / "a.exr"), OutputError);
}

TEST_F(AtomicWrite, TwoProcessesWritingOneNameLeaveOneWholeFile) {
  pid_t children[2];
  for (pid_t& child : children) {
    child = fork();
    if (child == 0) {
      for (int i = 0; i < 5; ++i)
        writeFileAtomically(path("a.bin"), std::string(100000, static_cast<char>('a' + getpid() % 26)));
      _exit(0);
    }
  }
  for (const pid_t child : children) {
    int status = 1;
    waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
  }
  const std::string bytes = readBytes(path("a.bin"));
  ASSERT_EQ(bytes.size(), 100000u);
  EXPECT_EQ(bytes.find_first_not_of(bytes[0]), std::string::npos);
  EXPECT_EQ(fileCount(), 1u);
}

} // namespace
} // namespace isophote
