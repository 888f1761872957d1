// `isophote render` from outside, on whatever device is present: what it writes, what it returns, how it stops.
#include <chrono>
#include <csignal>
#include <thread>

#include <nlohmann/json.hpp>

#include "unit/cli_fixture.hpp"

namespace isophote {
namespace {

class CliRender : public test::CommandLineOnDevice {
protected:
  [[nodiscard]] test::CommandResult render(const std::vector<std::string>& flags) const {
    std::vector<std::string> arguments = {"render", writeTriangle("triangle.gltf"), "--width", "24", "-o", image()};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    return run(arguments);
  }
  /// -v tells when it begins; on a busy machine a minute goes by at most.
  void waitForRendering(pid_t child) const {
    for (int i = 0; i < 3000 && output(child).find("features") == std::string::npos; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  }
  [[nodiscard]] std::string image() const { return path("image.exr").string(); }
};

TEST_F(CliRender, WritesTheLayersAndAttributesThatScriptsRead) {
  const auto result = render({"--spp", "16", "--seed", "7", "--max-depth", "3"});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const Image read = readExr(image());
  EXPECT_EQ(read.width, 24u);
  EXPECT_EQ(read.height, 12u); // the camera's aspect ratio is 2
  for (const char* name : {"R",          "G",          "B",          "A",        "stderr.R",      "stderr.G",
                           "stderr.B",   "ci95.R",     "ci95.G",     "ci95.B",   "sampleCount.Y", "albedo.R",
                           "albedo.G",   "albedo.B",   "normal.X",   "normal.Y", "normal.Z",      "depth.Z",
                           "position.X", "position.Y", "position.Z", "trust.Y"}) {
    EXPECT_NE(read.find(name), nullptr) << name;
  }
  for (const char* name :
       {"version", "scene", "sceneHash", "settings", "device", "features", "error", "bias", "status"}) {
    EXPECT_TRUE(read.attributes.contains(std::string("isophote.") + name)) << name;
  }
  EXPECT_EQ(read.attributes.at("isophote.seed"), "7");
  EXPECT_EQ(read.attributes.at("isophote.sampleRange"), "0:16");
  EXPECT_EQ(nlohmann::json::parse(read.attributes.at("isophote.bias")).at("max-depth").at("value"), 3);
  EXPECT_EQ(nlohmann::json::parse(read.attributes.at("isophote.settings")).at("camera"), "front");
  EXPECT_GT(nlohmann::json::parse(read.attributes.at("isophote.error")).at("value"), 0);
  EXPECT_GT(read.renderSeconds, 0);
  EXPECT_GT(*std::max_element(read.find("R")->values.begin(), read.find("R")->values.end()), 0);
}

// The image and all its layers stay as they are, bit for bit.
TEST_F(CliRender, DenoisesBesideTheImage) {
  ASSERT_EQ(render({"--spp", "16", "--quiet"}).exitCode, 0);
  const Image plain = readExr(image());
  const auto result = render({"--spp", "16", "--quiet", "--denoise"});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const Image both = readExr(image());
  EXPECT_EQ(plain.find("denoised.R"), nullptr);
  ASSERT_NE(both.find("denoised.R"), nullptr);
  EXPECT_EQ(both.channels.size(), plain.channels.size() + 3);
  for (const Channel& channel : plain.channels) EXPECT_EQ(both.find(channel.name)->values, channel.values);
  const auto bias = nlohmann::json::parse(both.attributes.at("isophote.bias"));
  EXPECT_EQ(bias.at("denoiser").at("layer"), "denoised.{R,G,B}");
  EXPECT_EQ(nlohmann::json::parse(both.attributes.at("isophote.settings")).at("denoiser"), "atrous");
  EXPECT_EQ(render({"--spp", "1", "--unbiased", "--denoise"}).exitCode, 2);
}

TEST_F(CliRender, UnbiasedRefusesABiasedSetting) {
  const auto refused = render({"--spp", "1", "--unbiased", "--max-depth", "3"});
  EXPECT_EQ(refused.exitCode, 2) << refused.err;
  EXPECT_NE(refused.err.find("max-depth"), std::string::npos) << refused.err;
  expectOneErrorLine(refused);
  const auto straight = render({"--spp", "1", "--unbiased", "--set", "shadow-transmission=straight"});
  EXPECT_EQ(straight.exitCode, 2) << straight.err;
  EXPECT_NE(straight.err.find("shadow-transmission"), std::string::npos) << straight.err;
  EXPECT_EQ(render({"--spp", "1", "--unbiased", "--quiet"}).exitCode, 0);
}

TEST_F(CliRender, WritesStatisticsAndPng) {
  const auto result = render({"-o", path("image.png").string(), "--stats", path("stats.json").string(), "--spp", "2"});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  EXPECT_TRUE(test::readBytes(path("image.png")).starts_with("\x89PNG"));
  const auto stats = nlohmann::json::parse(test::readBytes(path("stats.json")));
  EXPECT_EQ(stats.at("schema"), 1);
  EXPECT_EQ(stats.at("spp"), 2);
  EXPECT_EQ(stats.at("rays").at("primary"), 24 * 12 * 2);
  EXPECT_EQ(stats.at("bias"), nlohmann::json::object());
  for (const char* key : {"scene", "device", "driver", "features", "mrays_per_s", "error", "figure_of_merit"}) {
    EXPECT_TRUE(stats.contains(key)) << key;
  }
  for (const char* key : {"load", "bvh", "upload", "compile", "render", "device", "write"}) {
    EXPECT_TRUE(stats.at("seconds").at(key).is_number()) << key;
  }
  EXPECT_GE(stats.at("seconds").at("render"), stats.at("seconds").at("device"));
  for (const char* key : {"scene_bytes", "bvh_bytes", "queue_bytes", "film_bytes", "bytes_per_path"}) {
    EXPECT_GT(stats.at("memory").at(key), 0) << key;
  }
  for (const char* key : {"triangles", "nodes", "sah_cost", "max_depth"})
    EXPECT_TRUE(stats.at("bvh").contains(key)) << key;
  for (const auto& [name, count] : stats.at("status").items()) EXPECT_EQ(count, 0) << name;
  ASSERT_FALSE(stats.at("kernels").empty());
  for (const char* key : {"name", "dispatches", "ms", "compile_ms", "spirv_bytes"}) {
    EXPECT_TRUE(stats.at("kernels").at(0).contains(key)) << key;
  }
}

TEST_F(CliRender, StopsAtTheTargetErrorAtTheSameSampleEachTime) {
  uint32_t samples[2];
  for (uint32_t& count : samples) {
    const auto result =
        render({"--target-error", "30%", "--env-color", "1,1,1", "--quiet", "--stats", path("stats.json").string()});
    ASSERT_EQ(result.exitCode, 0) << result.err;
    const Image read = readExr(image());
    count = static_cast<uint32_t>(read.find("sampleCount.Y")->values.at(0));
    EXPECT_LE(nlohmann::json::parse(read.attributes.at("isophote.error")).at("interval").at(1), 0.30);
    const auto target = nlohmann::json::parse(test::readBytes(path("stats.json"))).at("target");
    EXPECT_EQ(target.at("reached"), true);
    EXPECT_EQ(target.at("looks").back().at("spp"), count);
    EXPECT_GE(target.at("looks").front().at("forecast_seconds").at(2), target.at("looks").front().at("seconds"));
  }
  EXPECT_EQ(samples[0], samples[1]);
  EXPECT_EQ(samples[0] % 8, 0u);
}

TEST_F(CliRender, PlansInsteadOfRendering) {
  const std::vector<std::string> arguments = {"render",         writeTriangle("triangle.gltf"),
                                              "--width",        "24",
                                              "--env-color",    "1,1,1",
                                              "--plan",         "--json",
                                              "--pilot",        "0.1",
                                              "--target-error", "1%",
                                              "--spp",          "64"};
  const auto result = run(arguments);
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const auto plan = nlohmann::json::parse(result.out);
  for (const char* stop : {"target_error", "spp"}) {
    for (const char* what : {"spp", "seconds", "error"}) {
      const auto& interval = plan.at(stop).at(what);
      EXPECT_GT(interval.at(1), 0) << stop << what;
      EXPECT_LE(interval.at(1), interval.at(0)) << stop << what;
      EXPECT_LE(interval.at(0), interval.at(2)) << stop << what;
    }
  }
  EXPECT_EQ(plan.at("spp").at("spp").at(0), 64);
  EXPECT_GT(plan.at("memory").at("film_bytes"), 24 * 12 * 256);
  EXPECT_EQ(fileCount(), 2u); // scene and buffer
}

TEST_F(CliRender, ExitsWithEightWhenTheBudgetEndsFirstAndSavesTheImage) {
  const auto result = render({"--target-error", "0.001%", "--spp", "8"});
  EXPECT_EQ(result.exitCode, 8) << result.err;
  EXPECT_EQ(readExr(image()).find("sampleCount.Y")->values.at(0), 8);
}

// Without a stop this would go on for 4e9 samples a pixel.
TEST_F(CliRender, StopsAtTheTimeGiven) {
  const auto result = render({"--time", "0.2"});
  EXPECT_EQ(result.exitCode, 0) << result.err;
  EXPECT_GE(readExr(image()).find("sampleCount.Y")->values.at(0), 1);
}

TEST_F(CliRender, ASignalThatAsksForAnEndSavesTheImageAndExitsWith130) {
  const std::string scene = writeTriangle("triangle.gltf");
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const pid_t child = start({"render", scene, "-o", image(), "--width", "24", "--spp", "4000000000", "-v"});
    waitForRendering(child);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    kill(child, signal);
    const auto result = wait(child);
    EXPECT_EQ(result.exitCode, 130) << signal << result.err;
    EXPECT_GE(readExr(image()).find("sampleCount.Y")->values.at(0), 1);
    std::filesystem::remove(image());
  }
}

bool hasEnded(pid_t child) {
  siginfo_t info{};
  return waitid(P_PID, static_cast<id_t>(child), &info, WEXITED | WNOHANG | WNOWAIT) == 0 && info.si_pid == child;
}

// The image is large, so that it is not saved before the second signal comes. Signals that a busy process has not seen
// yet count as one: there may be more than two.
TEST_F(CliRender, ASecondInterruptAbortsWithoutAnImage) {
  const pid_t child =
      start({"render", writeTriangle("triangle.gltf"), "-o", image(), "--width", "1500", "--spp", "4000000000", "-v"});
  waitForRendering(child);
  while (!hasEnded(child)) {
    kill(child, SIGINT);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  const auto result = wait(child);
  EXPECT_EQ(result.exitCode, -SIGINT) << result.err;
  EXPECT_FALSE(std::filesystem::exists(image()));
}

// A full disk is simulated in tests/unit/io_atomic_write_test.cpp; drivers' shader caches do not survive it here.
TEST_F(CliRender, AnOutputThatCannotBeWrittenInTheEndExitsWithSevenAndLeavesNoTrace) {
  const pid_t child =
      start({"render", writeTriangle("triangle.gltf"), "-o", image(), "--width", "24", "--time", "1", "-v"});
  waitForRendering(child);
  std::filesystem::create_directory(image());
  const auto result = wait(child);
  EXPECT_EQ(result.exitCode, 7) << result.err;
  EXPECT_EQ(fileCount(), 3u); // scene, buffer, and the folder in the way
}

TEST_F(CliRender, WarnsWhereNothingGivesLight) {
  std::string dark = test::readBytes(writeTriangle("triangle.gltf"));
  dark.replace(dark.find(R"("type": "point")"), 15, R"("type": "point", "intensity": 0)");
  test::writeBytes(path("dark.gltf"), dark);
  const std::vector<std::string> arguments = {
      "render", path("dark.gltf").string(), "-o", image(), "--width", "8", "--spp", "1", "--quiet"};
  const auto result = run(arguments);
  EXPECT_NE(result.err.find("gives light"), std::string::npos) << result.err;
}

TEST_F(CliRender, AnUnknownDeviceExitsWithSix) {
  const auto result = render({"--device", "Voodoo"});
  EXPECT_EQ(result.exitCode, 6) << result.err;
  expectOneErrorLine(result);
}

} // namespace
} // namespace isophote
