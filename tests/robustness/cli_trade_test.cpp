// `isophote trade` from outside: what it writes, what it finds, how it stops.
#include <chrono>
#include <csignal>
#include <thread>

#include <nlohmann/json.hpp>

#include "unit/cli_fixture.hpp"

namespace isophote {
namespace {

class CliTrade : public test::CommandLineOnDevice {
protected:
  [[nodiscard]] std::vector<std::string> arguments(const std::string& budget) const {
    return {"trade",      writeTriangle("triangle.gltf"),
            "-o",         path("study").string(),
            "--width",    "16",
            "--budget",   budget,
            "--settings", "sampler",
            "--settings", "max-depth=0",
            "--settings", "denoiser"};
  }
  [[nodiscard]] nlohmann::json study() const {
    return nlohmann::json::parse(test::readBytes(path("study") / "trade.json"));
  }
};

// A depth of 0 loses all the light of this scene; the sampler loses none. The study's own significance: 1%. Settings
// that are asked for are measured also where the budget, as here, is less than their kernels take to compile.
TEST_F(CliTrade, TellsABiasedSettingFromAnExactTwin) {
  const auto result = run(arguments("1"));
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const auto json = study();
  const auto& list = json.at("configurations");
  ASSERT_GE(list.size(), 4u);
  EXPECT_EQ(list[0].at("name"), "exact");
  EXPECT_EQ(list[1].at("name"), "sampler=independent");
  EXPECT_FALSE(list[1].at("bias_seen"));
  EXPECT_TRUE(list[1].at("declared_unbiased"));
  EXPECT_GT(list[1].at("relative_to_exact").at("noise_square").at("value"), 0);
  EXPECT_EQ(list[2].at("name"), "max-depth=0");
  EXPECT_TRUE(list[2].at("bias_seen"));
  EXPECT_NEAR(list[2].at("brightness").at("value").get<double>(), -1, 0.01);
  EXPECT_EQ(list[3].at("name"), "denoiser=atrous");
  EXPECT_EQ(list[3].at("layer"), "denoised");
  EXPECT_FALSE(list[3].at("on_front"));
  EXPECT_GT(list[3].at("noise_square").at("value"), 0); // though it has no error bars
  ASSERT_EQ(json.at("recommendations").size(), 3u);
  for (const auto& recommendation : json.at("recommendations")) {
    EXPECT_FALSE(recommendation.at("settings").contains("max-depth")) << recommendation;
    EXPECT_FALSE(recommendation.at("settings").contains("denoiser")) << recommendation;
    EXPECT_GE(recommendation.at("confirmation").at("runs"), 2) << recommendation;
  }
  const std::string page = test::readBytes(path("study") / "trade.html");
  EXPECT_NE(page.find("data:image/png;base64,"), std::string::npos);
  EXPECT_NE(page.find("<svg"), std::string::npos);
  EXPECT_EQ(page.find("http"), std::string::npos); // it needs nothing beside it
  const std::string csv = test::readBytes(path("study") / "trade.csv");
  EXPECT_EQ(static_cast<size_t>(std::count(csv.begin(), csv.end(), '\n')), list.size() + 1);
}

TEST_F(CliTrade, AnInterruptKeepsWhatWasMeasured) {
  const pid_t child = start(arguments("600"));
  // The files appear at the end only; a second is after the first kernels and long before the end.
  std::this_thread::sleep_for(std::chrono::seconds(3));
  kill(child, SIGINT);
  const auto result = wait(child);
  EXPECT_EQ(result.exitCode, 130) << result.err;
  EXPECT_TRUE(study().at("interrupted"));
  EXPECT_NE(test::readBytes(path("study") / "trade.html").find("Interrupted"), std::string::npos);
}

TEST_F(CliTrade, RefusesSettingsThatDoNotExistAndReferencesWithoutErrorBars) {
  auto unknown = arguments("5");
  unknown.back() = "speed=high";
  const auto first = run(unknown);
  EXPECT_EQ(first.exitCode, 2);
  expectOneErrorLine(first);

  Image plain{.width = 16, .height = 8};
  for (const char* name : {"R", "G", "B"}) plain.channels.push_back({name, std::vector<float>(128, 0.5f)});
  writeExr(path("plain.exr"), plain);
  const auto second = run({"trade", writeTriangle("triangle.gltf"), "-o", path("study").string(), "--reference",
                           path("plain.exr").string()});
  EXPECT_EQ(second.exitCode, 2);
  expectOneErrorLine(second);
}

} // namespace
} // namespace isophote
