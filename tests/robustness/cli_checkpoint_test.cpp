// `isophote render --checkpoint`: whatever ends a render, what goes on from its checkpoint has the bits of one that was
// never interrupted.
#include <chrono>
#include <csignal>
#include <optional>
#include <random>
#include <thread>

#include <nlohmann/json.hpp>

#include "isophote/checkpoint.hpp"
#include "support/render.hpp"
#include "unit/cli_fixture.hpp"

namespace isophote {
namespace {

using std::chrono::milliseconds;

class CliCheckpoint : public test::CommandLineOnDevice {
protected:
  void SetUp() override {
    CommandLineOnDevice::SetUp();
    if (!IsSkipped()) scene_ = writeTriangle("triangle.gltf");
  }

  [[nodiscard]] std::vector<std::string> command(const std::string& output, const std::string& spp,
                                                 const std::vector<std::string>& flags) const {
    std::vector<std::string> arguments = {"render", scene_, "-o", path(output).string(), "--width", "72", "--spp", spp};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    return arguments;
  }
  [[nodiscard]] std::string checkpoint() const { return path("state.ckpt").string(); }
  [[nodiscard]] std::vector<std::string> resuming(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> flags = {"--checkpoint", checkpoint(), "--checkpoint-every", "0.02", "--resume"};
    flags.insert(flags.end(), more.begin(), more.end());
    return flags;
  }
  [[nodiscard]] Image renderWhole(const std::string& spp, const std::vector<std::string>& flags = {}) const {
    const auto result = run(command("whole.exr", spp, flags));
    EXPECT_EQ(result.exitCode, 0) << result.err;
    return readExr(path("whole.exr"));
  }

  [[nodiscard]] std::optional<std::filesystem::file_time_type> saved() const {
    std::error_code none;
    const auto time = std::filesystem::last_write_time(checkpoint(), none);
    return none ? std::nullopt : std::optional(time);
  }

  /// Starts, waits for a checkpoint, and ends it by `signal` at a random moment, `times` times; then lets it end.
  [[nodiscard]] Image renderInterrupted(const std::string& spp, int times, int signal) const {
    std::mt19937 random(1);
    int withinASample = 0;
    for (int i = 0; i < times; ++i) {
      const auto before = saved();
      const pid_t child = start(command("resumed.exr", spp, resuming()));
      for (int wait = 0; wait < 6000 && saved() == before; ++wait) std::this_thread::sleep_for(milliseconds(5));
      std::this_thread::sleep_for(milliseconds(random() % 100));
      kill(child, signal);
      std::ignore = wait(child);
      const SampleRange left = readCheckpoint(checkpoint()).left;
      EXPECT_LT(left.first, left.last) << "the render was over before it was stopped";
      withinASample += left.begun != 0 ? 1 : 0;
    }
    EXPECT_GT(withinASample, 0);
    const auto result = run(command("resumed.exr", spp, resuming()));
    EXPECT_EQ(result.exitCode, 0) << result.err;
    return readExr(path("resumed.exr"));
  }

  std::string scene_;
};

// More than are rendered before the last break.
constexpr const char* kSamples = "3000";

TEST_F(CliCheckpoint, Test64KilledRendersEndWithTheSameBits) {
  EXPECT_TRUE(test::bitIdentical(renderInterrupted(kSamples, 3, SIGKILL), renderWhole(kSamples)));
}

TEST_F(CliCheckpoint, Test64KilledTwoHundredTimesSlow) {
  EXPECT_TRUE(test::bitIdentical(renderInterrupted("60000", 200, SIGKILL), renderWhole("60000")));
}

TEST_F(CliCheckpoint, RendersThatWereAskedToStopGoOnAndEndWithTheSameBits) {
  EXPECT_TRUE(test::bitIdentical(renderInterrupted(kSamples, 1, SIGINT), renderWhole(kSamples)));
}

TEST_F(CliCheckpoint, MoreSamplesAreAddedToAFinishedRender) {
  ASSERT_EQ(run(command("first.exr", "20", resuming())).exitCode, 0);
  const double before = readCheckpoint(checkpoint()).seconds;
  const std::vector<std::string> stats = {"--stats", path("stats.json").string()};
  ASSERT_EQ(run(command("more.exr", "37", resuming(stats))).exitCode, 0);
  const auto seconds = nlohmann::json::parse(test::readBytes(path("stats.json"))).at("seconds");
  EXPECT_GT(seconds.at("render"), before + seconds.at("device").get<double>());
  EXPECT_TRUE(test::bitIdentical(readExr(path("more.exr")), renderWhole("37")));
}

TEST_F(CliCheckpoint, ATargetErrorIsReachedAtTheSameSample) {
  const std::vector<std::string> target = {"--target-error", "1%", "--env-color", "1,1,1"};
  const Image whole = renderWhole("4096", target);
  for (const char* spp : {"16", "37"}) { // in a pause between passes, and within one
    ASSERT_EQ(run(command("part.exr", spp, resuming(target))).exitCode, 8);
    const auto resumed = run(command("resumed.exr", "4096", resuming(target)));
    ASSERT_EQ(resumed.exitCode, 0) << resumed.err;
    EXPECT_TRUE(test::bitIdentical(readExr(path("resumed.exr")), whole)) << spp;
    std::filesystem::remove(checkpoint());
  }
}

TEST_F(CliCheckpoint, AnothersCheckpointIsRefusedWithTheDifference) {
  ASSERT_EQ(run(command("first.exr", "8", resuming())).exitCode, 0);
  struct Other {
    std::vector<std::string> flags;
    const char* difference;
  };
  for (const Other& other : {Other{{"--seed", "9"}, "seed"}, Other{{"--sampler", "independent"}, "sampler"},
                             Other{{"--max-depth", "2"}, "max-depth"}, Other{{"--height", "40"}, "image"},
                             Other{{"--env-color", "1,1,1"}, "environment"}}) {
    const auto refused = run(command("other.exr", "8", resuming(other.flags)));
    EXPECT_EQ(refused.exitCode, 2) << other.difference;
    EXPECT_NE(refused.err.find(other.difference), std::string::npos) << refused.err;
    expectOneErrorLine(refused);
    EXPECT_FALSE(std::filesystem::exists(path("other.exr")));
  }
}

TEST_F(CliCheckpoint, ADamagedCheckpointIsRefusedAndStays) {
  ASSERT_EQ(run(command("first.exr", "8", resuming())).exitCode, 0);
  std::filesystem::resize_file(checkpoint(), std::filesystem::file_size(checkpoint()) / 2);
  const std::string before = test::readBytes(checkpoint());
  const auto refused = run(command("other.exr", "8", resuming()));
  EXPECT_EQ(refused.exitCode, 3);
  expectOneErrorLine(refused);
  EXPECT_EQ(test::readBytes(checkpoint()), before);
}

} // namespace
} // namespace isophote
