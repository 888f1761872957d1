// The search for the number of paths in flight, without a device, and what is kept of it.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "render/paths_in_flight.hpp"
#include "support/cache_folder.hpp"
#include "support/gpu_device.hpp"

namespace isophote {
namespace {

using test::gpuDevice;

constexpr uint32_t kFewest = 1 << 10;
constexpr uint32_t kFirst = 1 << 13;
constexpr uint32_t kMost = 1 << 16;
constexpr double kSubmit = 100; // milliseconds

/// Submits until the search is settled; speeds fall off on both sides of `peak`, by a tenth for a factor of two.
uint32_t settle(
    double peak, const std::function<double(int)>& slowdown = [](int) { return 1.0; }) {
  PathsInFlight search(kFirst, kFewest, kMost);
  EXPECT_EQ(search.count(), kFirst);
  int submits = 0;
  for (; submits < 1000 && !search.isSettled(); ++submits) {
    const double speed = 1e5 * (1 - 0.1 * std::abs(std::log2(search.count() / peak))) / slowdown(submits);
    search.add(static_cast<uint64_t>(speed * kSubmit), kSubmit);
    EXPECT_GE(search.count(), kFewest);
    EXPECT_LE(search.count(), kMost);
  }
  EXPECT_LT(submits, 400);
  return search.count();
}

TEST(PathsInFlight, TheBestIsFoundWhereverItIs) {
  for (uint32_t peak = kFewest; peak <= kMost; peak *= 2) EXPECT_EQ(settle(peak), peak);
  EXPECT_EQ(settle(kFewest / 4), kFewest);
  EXPECT_EQ(settle(kMost * 4), kMost);
}

TEST(PathsInFlight, SubmitsThatWaitedAndAMachineThatSlowsDownDecideNothing) {
  EXPECT_EQ(settle(kFirst / 4, [](int submit) { return submit % 5 == 4 ? 3.0 : 1.0; }), kFirst / 4);
  EXPECT_EQ(settle(kFirst * 4, [](int submit) { return 1 + 0.002 * submit; }), kFirst * 4);
}

TEST(PathsInFlight, EqualSpeedsKeepTheFirst) {
  PathsInFlight search(kFirst, kFewest, kMost);
  while (!search.isSettled()) search.add(1000, kSubmit);
  EXPECT_EQ(search.count(), kFirst);
  search.add(1, kSubmit);
  EXPECT_EQ(search.count(), kFirst);
}

TEST(PathsInFlight, WhatWasAskedForIsNotSearched) {
  EXPECT_TRUE(PathsInFlight(3).isSettled());
  EXPECT_EQ(PathsInFlight(3).count(), 3u);
}

class KeptPathsInFlight : public testing::Test {
protected:
  test::CacheFolder folder_;
  PathsRange range_ = pathsRange(gpuDevice(), Pipeline::Fused);

  [[nodiscard]] std::filesystem::path file() const { return folder_.files().at(0); }
};

TEST_F(KeptPathsInFlight, IsThereInTheNextRunForEachPipeline) {
  EXPECT_FALSE(recallPathsInFlight(gpuDevice(), Pipeline::Fused).isSettled());
  rememberPathsInFlight(gpuDevice(), Pipeline::Fused, range_.fewest);
  rememberPathsInFlight(gpuDevice(), Pipeline::Wavefront, range_.fewest * 2);
  EXPECT_EQ(file().extension(), ".json");
  for (const Pipeline pipeline : {Pipeline::Fused, Pipeline::Wavefront}) {
    const PathsInFlight recalled = recallPathsInFlight(gpuDevice(), pipeline);
    EXPECT_TRUE(recalled.isSettled());
    EXPECT_EQ(recalled.count(), range_.fewest * (pipeline == Pipeline::Fused ? 1 : 2));
  }
}

TEST_F(KeptPathsInFlight, AFileOfSomethingElseIsASearch) {
  rememberPathsInFlight(gpuDevice(), Pipeline::Fused, range_.fewest);
  const std::string place = R"({"paths_in_flight": {"fused": {"of_)" + std::to_string(range_.most) + "\": ";
  for (const std::string& text :
       {std::string("garbage"), std::string("[1]"), std::string(R"({"paths_in_flight": 3})"), place + "-1}}}",
        place + "0}}}", place + "1e9}}}", place + "4294975488}}}", place + "\"x\"}}}",
        std::string(5000, ' ') + place + std::to_string(range_.fewest) + "}}}"}) {
    std::ofstream(file(), std::ios::trunc) << text;
    EXPECT_FALSE(recallPathsInFlight(gpuDevice(), Pipeline::Fused).isSettled()) << text;
  }
  std::ofstream(file(), std::ios::trunc) << place << range_.fewest << "}}}";
  EXPECT_TRUE(recallPathsInFlight(gpuDevice(), Pipeline::Fused).isSettled());
}

TEST_F(KeptPathsInFlight, AFolderThatCannotBeWrittenChangesNothing) {
  std::ofstream(folder_.own()) << "a file where the folder should be";
  EXPECT_NO_THROW(rememberPathsInFlight(gpuDevice(), Pipeline::Fused, range_.fewest));
  EXPECT_FALSE(recallPathsInFlight(gpuDevice(), Pipeline::Fused).isSettled());
}

} // namespace
} // namespace isophote
