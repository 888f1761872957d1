// Checkpoints on disk, without a device: what is written is read, and nothing else is taken for it.
#include <span>

#include <gtest/gtest.h>

#include "isophote/checkpoint.hpp"
#include "isophote/error.hpp"
#include "shared/film_types.h"
#include "unit/io_fixture.hpp"

namespace isophote {
namespace {

template <class T> std::vector<std::byte> bytesOf(const std::vector<T>& items) {
  const auto bytes = std::as_bytes(std::span(items));
  return {bytes.begin(), bytes.end()};
}

FilmSums onePixel(int64_t red, uint32_t count) {
  std::vector<gpu::ReplicateSum> replicates(gpu::kReplicateCount);
  for (auto& sum : replicates) sum = {.red = red, .green = -red, .blue = 1, .count = count, .hitCount = 1};
  std::vector<gpu::AovSum> aovs(1);
  aovs[0].depth = red;
  aovs[0].count = count;
  return {.options = {.width = 1, .height = 1, .crop = {0, 0, 1, 1}},
          .radiancePerUnit = 0x1p-36,
          .lengthPerUnit = 0x1p-30,
          .worldOrigin = {0.1, -2e8, 3},
          .replicates = bytesOf(replicates),
          .aovs = bytesOf(aovs)};
}

const gpu::ReplicateSum& firstReplicate(const FilmSums& sums) {
  return *reinterpret_cast<const gpu::ReplicateSum*>(sums.replicates.data());
}

Checkpoint someCheckpoint() {
  return {.identity = R"({"seed":1})",
          .left = {.first = 7, .last = 64, .begun = 1ull << 40},
          .seconds = 0.1,
          .sums = onePixel(1ll << 60, 5)};
}

class CheckpointFile : public test::InTemporaryFolder {
protected:
  [[nodiscard]] std::string written() const {
    writeCheckpoint(path("a"), someCheckpoint());
    return test::readBytes(path("a"));
  }
  void expectRefused(const std::string& bytes) const {
    test::writeBytes(path("b"), bytes);
    EXPECT_THROW(std::ignore = readCheckpoint(path("b")), SceneError) << bytes.size();
  }
};

TEST_F(CheckpointFile, IsReadAsItWasWritten) {
  std::ignore = written();
  const Checkpoint read = readCheckpoint(path("a"));
  const Checkpoint expected = someCheckpoint();
  EXPECT_EQ(read.identity, expected.identity);
  EXPECT_EQ(read.left, expected.left);
  EXPECT_EQ(read.seconds, expected.seconds);
  EXPECT_EQ(read.sums.options.crop, expected.sums.options.crop);
  EXPECT_EQ(read.sums.worldOrigin, expected.sums.worldOrigin);
  EXPECT_EQ(read.sums.radiancePerUnit, expected.sums.radiancePerUnit);
  EXPECT_EQ(read.sums.lengthPerUnit, expected.sums.lengthPerUnit);
  EXPECT_EQ(read.sums.replicates, expected.sums.replicates);
  EXPECT_EQ(read.sums.aovs, expected.sums.aovs);
}

TEST_F(CheckpointFile, CutOffAnywhereItIsRefused) {
  const std::string bytes = written();
  for (size_t length = 0; length < bytes.size(); ++length) expectRefused(bytes.substr(0, length));
  expectRefused(bytes + '\0');
}

TEST_F(CheckpointFile, WithAnyBitFlippedItIsRefused) {
  const std::string bytes = written();
  for (size_t at = 0; at < bytes.size(); ++at) {
    std::string damaged = bytes;
    damaged[at] = static_cast<char>(damaged[at] ^ (1 << at % 8));
    expectRefused(damaged);
  }
}

TEST(FilmSums, AddInteger) {
  FilmSums sums = onePixel(100, 5);
  addSums(sums, onePixel(-30, 7));
  EXPECT_EQ(firstReplicate(sums).red, 70);
  EXPECT_EQ(firstReplicate(sums).green, -70);
  EXPECT_EQ(firstReplicate(sums).count, 12u);
  EXPECT_EQ(reinterpret_cast<const gpu::AovSum*>(sums.aovs.data())->depth, 70);
}

TEST(FilmSums, OverflowIsRefusedAndChangesNothing) {
  FilmSums sums = onePixel(1ll << 62, 5);
  EXPECT_THROW(addSums(sums, onePixel(1ll << 62, 5)), LimitError);
  EXPECT_EQ(firstReplicate(sums).red, 1ll << 62);
  EXPECT_THROW(addSums(sums, onePixel(0, ~0u)), LimitError);
}

TEST(FilmSums, OfAnotherImageAreRefused) {
  FilmSums sums = onePixel(1, 1);
  FilmSums other = onePixel(1, 1);
  other.radiancePerUnit *= 2;
  EXPECT_THROW(addSums(sums, other), UsageError);
  other = onePixel(1, 1);
  other.options.crop.x0 = 1;
  EXPECT_THROW(addSums(sums, other), UsageError);
}

} // namespace
} // namespace isophote
