#include <nlohmann/json.hpp>

#include "unit/cli_fixture.hpp"

namespace isophote {
namespace {

class CliUsage : public test::CommandLine {};

TEST_F(CliUsage, HelpTeachesEveryCommandWithExamples) {
  const auto program = run({"--help"});
  EXPECT_EQ(program.exitCode, 0);
  for (const char* command : {"render", "info", "devices", "compare", "bench", "settings"}) {
    EXPECT_NE(program.out.find(std::string("  ") + command), std::string::npos) << command;
    const auto help = run({command, "--help"});
    EXPECT_EQ(help.exitCode, 0) << command;
    EXPECT_EQ(help.err, "") << command;
    EXPECT_NE(help.out.find("Examples:\n  isophote " + std::string(command)), std::string::npos) << help.out;
  }
}

TEST_F(CliUsage, TellsItsVersion) {
  const auto result = run({"--version"});
  EXPECT_EQ(result.exitCode, 0);
  EXPECT_EQ(result.out.find_first_not_of("0123456789.\n"), std::string::npos) << result.out;
}

TEST_F(CliUsage, WrongCommandsExitWithTwoAndOneLine) {
  const std::vector<std::vector<std::string>> wrong = {{},
                                                       {"rendr"},
                                                       {"render"},
                                                       {"--nonsense"},
                                                       {"info"},
                                                       {"info", "a.glb", "b.glb"},
                                                       {"compare", "a.exr"},
                                                       {"bench"},
                                                       {"bench", "a.glb", "--time", "0"},
                                                       {"devices", "extra"},
                                                       {"settings", "--jsn"}};
  for (const auto& arguments : wrong) {
    const auto result = run(arguments);
    EXPECT_EQ(result.exitCode, 2) << (arguments.empty() ? "" : arguments[0]) << ": " << result.err;
    expectOneErrorLine(result);
  }
}

TEST_F(CliUsage, WrongRenderFlagsExitWithTwoAndNameTheFlag) {
  const std::vector<std::pair<std::string, std::vector<std::string>>> wrong = {
      {"--spp", {"0", "-1", "1.5", "4294967296", "18446744073709551617", "many", "", "0x10"}},
      {"--samples", {"0"}},
      {"--width", {"0", "65536", "-4"}},
      {"--height", {"0", "1e3"}},
      {"--seed", {"-1", "18446744073709551616", "abc"}},
      {"--max-depth", {"-1", "infinite", "4294967296"}},
      {"--sample-range", {"5", "5:5", "7:3", "0:4294967296", "a:b", "1:2:3"}},
      {"--target-error", {"0", "0%", "-1%", "nan", "inf", "%", "2 %"}},
      {"--time", {"0", "-3", "nan", "1h"}},
      {"--crop", {"0,0,10", "0,0,0,10", "5,5,4,9", "0,0,70000,1", "a,b,c,d"}},
      {"--exposure", {"nan", "inf", "1000", "bright"}},
      {"--tonemap", {"filmic"}},
      {"--filter", {"triangle"}},
      {"--sampler", {"halton"}},
      {"--sky", {"91", "-1", "45,0,1", "45,0,3,1", "noon"}},
      {"--env-color", {"1,1", "1,1,-1", "nan,0,0", "white"}},
      {"--env-intensity", {"-1", "nan"}},
      {"--env-rotation", {"north"}},
      {"--set", {"nonsense=1", "max-depth", "max-depth=-1", "=", "sampler=halton"}}};
  for (const auto& [flag, values] : wrong) {
    for (const std::string& value : values) {
      const auto result = run({"render", "scene.glb", "-o", path("a.exr").string(), flag, value});
      EXPECT_EQ(result.exitCode, 2) << flag << " '" << value << "': " << result.err;
      EXPECT_NE(result.err.find(flag == "--samples" ? "--spp"
                                : flag == "--set"   ? ""
                                                    : flag),
                std::string::npos)
          << result.err;
      expectOneErrorLine(result);
    }
  }
}

TEST_F(CliUsage, RefusesFlagsThatExcludeEachOther) {
  for (const auto& flags :
       {std::vector<std::string>{"--spp", "4", "--sample-range", "0:4"}, {"--env", "a.hdr", "--env-color", "1,1,1"}}) {
    std::vector<std::string> arguments = {"render", "scene.glb", "-o", path("a.exr").string()};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    const auto result = run(arguments);
    EXPECT_EQ(result.exitCode, 2) << result.err;
    expectOneErrorLine(result);
  }
}

TEST_F(CliUsage, RefusesOutputsItCannotWriteBeforeLoadingAnything) {
  const auto code = [&](const std::vector<std::string>& outputs) {
    std::vector<std::string> arguments = {"render", path("absent.glb").string()};
    arguments.insert(arguments.end(), outputs.begin(), outputs.end());
    const auto result = run(arguments);
    expectOneErrorLine(result);
    return result.exitCode;
  };
  EXPECT_EQ(code({"-o", path("a.jpg").string()}), 2);
  EXPECT_EQ(code({"-o", path("a").string()}), 2);
  EXPECT_EQ(code({"-o", path("a.exr").string(), "-o", path("a.exr").string()}), 2);
  EXPECT_EQ(code({"-o", path("nowhere/a.exr").string()}), 7);
  EXPECT_EQ(code({"-o", path("a.exr").string(), "--stats", path("nowhere/s.json").string()}), 7);
  EXPECT_EQ(code({"-o", path("a.exr").string()}), 3);
  EXPECT_EQ(fileCount(), 0u);
}

TEST_F(CliUsage, MissingInputsExitWithThreeAndNameTheFile) {
  const std::string absent = path("absent.glb").string();
  for (const auto& arguments : {std::vector<std::string>{"render", absent, "-o", path("a.exr").string()},
                                {"info", absent},
                                {"bench", absent},
                                {"compare", absent, absent},
                                {"info", path(".").string()}}) {
    const auto result = run(arguments);
    EXPECT_EQ(result.exitCode, 3) << arguments[0] << ": " << result.err;
    EXPECT_NE(result.err.find(path("").string()), std::string::npos) << result.err;
    expectOneErrorLine(result);
  }
}

TEST_F(CliUsage, NeverReplacesAnInput) {
  const std::string scene = writeTriangle("triangle.gltf");
  const std::string before = test::readBytes(scene);
  writeExr(path("sky.exr"), test::noiseImage(4, 2, {"R", "G", "B"}));
  const std::string sky = test::readBytes(path("sky.exr"));
  std::filesystem::create_hard_link(path("triangle.bin"), path("linked.png"));
  for (const auto& flags : {std::vector<std::string>{"-o", path("a.exr").string(), "--stats", scene},
                            {"-o", path("sky.exr").string(), "--env", path("sky.exr").string()},
                            {"-o", path("linked.png").string()}}) {
    std::vector<std::string> arguments = {"render", scene};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    const auto result = run(arguments);
    EXPECT_EQ(result.exitCode, 2) << result.err;
    expectOneErrorLine(result);
  }
  EXPECT_EQ(test::readBytes(scene), before);
  EXPECT_EQ(test::readBytes(path("sky.exr")), sky);
  EXPECT_EQ(std::filesystem::file_size(path("triangle.bin")), 36u);
}

TEST_F(CliUsage, AnUnknownCameraIsNamedWithThoseThereAre) {
  const auto result = run({"render", writeTriangle("triangle.gltf"), "-o", path("a.exr").string(), "--camera", "back"});
  EXPECT_EQ(result.exitCode, 2);
  EXPECT_NE(result.err.find("'back'"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("0 'front'"), std::string::npos) << result.err;
}

TEST_F(CliUsage, EnvironmentFlagsNeedAnEnvironment) {
  const auto result =
      run({"render", writeTriangle("triangle.gltf"), "-o", path("a.exr").string(), "--env-intensity", "2"});
  EXPECT_EQ(result.exitCode, 2) << result.err;
}

TEST_F(CliUsage, ALensNeedsADistanceToFocusAt) {
  const auto result =
      run({"render", writeTriangle("triangle.gltf"), "-o", path("a.exr").string(), "--lens-radius", "0.1"});
  EXPECT_EQ(result.exitCode, 2);
  EXPECT_NE(result.err.find("--focus-distance"), std::string::npos) << result.err;
}

TEST_F(CliUsage, ListsEverySettingWithItsDefault) {
  const auto result = run({"settings", "--json"});
  EXPECT_EQ(result.exitCode, 0);
  const auto json = nlohmann::json::parse(result.out);
  bool maxDepth = false;
  for (const auto& entry : json.at("settings")) {
    EXPECT_FALSE(entry.at("description").get<std::string>().empty());
    // The defaults are unbiased.
    EXPECT_EQ(entry.at("default"), entry.at("exact")) << entry.at("key");
    maxDepth = maxDepth || entry.at("key") == "max-depth";
  }
  EXPECT_TRUE(maxDepth);
}

} // namespace
} // namespace isophote
