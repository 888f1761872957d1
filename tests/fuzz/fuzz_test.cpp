// The inputs that the fuzzer kept, each once as it is and with some damage. Under ISOPHOTE_SANITIZE this also shows
// that nothing is read or written out of bounds. The search itself: scripts/fuzz.
#include <algorithm>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

#include "fuzz/fuzz_target.hpp"
#include "fuzz/gltf_mutator.hpp"

namespace isophote::fuzz {
namespace {

std::vector<std::filesystem::path> corpusOf(const std::string& target) {
  std::vector<std::filesystem::path> files;
  const auto folder = std::filesystem::path(ISOPHOTE_SOURCE_DIR) / "tests/fuzz/corpus" / target;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

std::string contentOf(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// A few flipped bits, or a piece missing.
std::string damaged(std::string bytes, std::mt19937& random) {
  if (bytes.empty()) return bytes;
  if (random() % 4 == 0) return bytes.erase(random() % bytes.size(), 1 + random() % 64);
  for (uint32_t i = random() % 4 + 1; i > 0; --i)
    bytes[random() % bytes.size()] ^= static_cast<char>(1u << random() % 8);
  return bytes;
}

class Corpus : public testing::TestWithParam<FuzzTarget> {};

TEST_P(Corpus, IsReadOrRefused) {
  const test::TemporaryFolder folder;
  std::mt19937 random(1);
  const auto files = corpusOf(GetParam().name);
  int accepted = 0;
  for (const auto& file : files) {
    SCOPED_TRACE(file.string());
    const std::string bytes = contentOf(file);
    accepted += accepts(GetParam(), folder, bytes);
    for (int i = 0; i < 8; ++i) {
      SCOPED_TRACE(testing::Message() << "damage " << i);
      (void)accepts(GetParam(), folder, damaged(bytes, random));
      if (GetParam().name == std::string("scene")) (void)accepts(GetParam(), folder, mutateGltf(bytes, random));
    }
  }
  EXPECT_GE(accepted, 1);
  EXPECT_LT(accepted, static_cast<int>(files.size())) << "a corpus has files of both kinds";
}

INSTANTIATE_TEST_SUITE_P(Fuzz, Corpus, testing::ValuesIn(fuzzTargets().begin(), fuzzTargets().end()),
                         [](const auto& test) { return std::string(test.param.name); });

} // namespace
} // namespace isophote::fuzz
