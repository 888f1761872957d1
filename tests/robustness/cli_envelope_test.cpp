// `isophote envelope` from outside.
#include <chrono>
#include <csignal>
#include <thread>

#include <nlohmann/json.hpp>

#include "unit/cli_fixture.hpp"

namespace isophote {
namespace {

class CliEnvelope : public test::CommandLineOnDevice {
protected:
  [[nodiscard]] std::string file(const std::string& name) const { return test::readBytes(path("envelope") / name); }
};

TEST_F(CliEnvelope, WritesRangesPointsAndACurve) {
  const auto result =
      run({"envelope", "-o", path("envelope").string(), "--quick", "--only", "absorption", "--json", "--quiet"});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json, nlohmann::json::parse(file("envelope.json")));
  const auto& sweep = json.at("sweeps").at(0);
  EXPECT_EQ(sweep.at("name"), "absorption");
  ASSERT_EQ(sweep.at("points").size(), 3u);
  EXPECT_EQ(sweep.at("below_0.1_percent").at("first"), 1e-8);
  EXPECT_TRUE(sweep.at("below_0.1_percent").at("whole"));
  const std::string csv = file("envelope.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 4);
  EXPECT_NE(file("README.md").find("absorption.svg"), std::string::npos);
  EXPECT_TRUE(file("absorption.svg").starts_with("<svg xmlns"));
}

TEST_F(CliEnvelope, AnUnknownSweepIsRefusedWithThoseThereAre) {
  const auto result = run({"envelope", "-o", path("envelope").string(), "--only", "speed"});
  EXPECT_EQ(result.exitCode, 2);
  expectOneErrorLine(result);
  EXPECT_NE(result.err.find("roughness-sun"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(path("envelope")));
}

TEST_F(CliEnvelope, AnInterruptKeepsWhatWasMeasured) {
  const pid_t child = start({"envelope", "-o", path("envelope").string()});
  std::this_thread::sleep_for(std::chrono::seconds(3));
  kill(child, SIGINT);
  const auto result = wait(child);
  EXPECT_EQ(result.exitCode, 130) << result.err;
  EXPECT_TRUE(nlohmann::json::parse(file("envelope.json")).at("interrupted"));
}

} // namespace
} // namespace isophote
