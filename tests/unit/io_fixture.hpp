// A folder of its own for each test, and small images to put there.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "isophote/image.hpp"

namespace isophote::test {

class InTemporaryFolder : public ::testing::Test {
protected:
  void SetUp() override {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() /
              ("isophote-" + std::to_string(getpid()) + "-" + info->test_suite_name() + "-" + info->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override {
    std::filesystem::permissions(folder_, std::filesystem::perms::owner_all);
    std::filesystem::remove_all(folder_);
  }
  [[nodiscard]] std::filesystem::path path(const std::string& name) const { return folder_ / name; }
  [[nodiscard]] size_t fileCount() const {
    return static_cast<size_t>(std::distance(std::filesystem::directory_iterator(folder_), {}));
  }

private:
  std::filesystem::path folder_;
};

inline std::string readBytes(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

inline void writeBytes(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

/// Noise in [0, 1), seeded by the size.
inline Image noiseImage(uint32_t width, uint32_t height, const std::vector<std::string>& channels) {
  std::mt19937 random(width * 1000 + height);
  std::uniform_real_distribution<float> uniform(0, 1);
  Image image;
  image.width = width;
  image.height = height;
  for (const std::string& name : channels) {
    image.channels.push_back({name, std::vector<float>(size_t(width) * height)});
    for (float& value : image.channels.back().values) value = uniform(random);
  }
  return image;
}

} // namespace isophote::test
