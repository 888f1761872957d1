#include <cmath>

#include <nlohmann/json.hpp>

#include "unit/cli_fixture.hpp"

namespace isophote {
namespace {

class CliCompare : public test::CommandLine {
protected:
  /// 32 x 32 pixels of 0.5 with normal noise and error bars of 0.01, off by `bias`.
  std::string writeNoisy(const std::string& name, uint32_t seed, float bias, bool errorBars = true) const {
    std::mt19937 random(seed);
    std::normal_distribution<float> noise(0.5f + bias, 0.01f);
    Image image = test::noiseImage(32, 32, {"R", "G", "B"});
    for (Channel& channel : image.channels) {
      for (float& value : channel.values) value = noise(random);
    }
    if (errorBars) {
      for (const char* error : {"stderr.R", "stderr.G", "stderr.B"})
        image.channels.push_back({error, std::vector<float>(1024, 0.01f)});
    }
    writeExr(path(name), image);
    return path(name).string();
  }
};

TEST_F(CliCompare, FindsTwoRendersOfOneSceneTheSame) {
  const auto result = run({"compare", writeNoisy("a.exr", 1, 0), writeNoisy("b.exr", 2, 0), "--json"});
  EXPECT_EQ(result.exitCode, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_TRUE(json.at("verdict").at("same"));
  EXPECT_GT(json.at("verdict").at("p"), 0.001);
  EXPECT_NEAR(json.at("rmse"), 0.01 * std::sqrt(2.0), 0.001);
  EXPECT_NEAR(json.at("relMSE"), 2e-4 / 0.25, 1e-4);
  EXPECT_GT(json.at("flip"), 0);
}

TEST_F(CliCompare, ExitsWithOneWhereTheyDifferByMoreThanNoise) {
  const auto result = run({"compare", writeNoisy("a.exr", 1, 0.01f), writeNoisy("b.exr", 2, 0)});
  EXPECT_EQ(result.exitCode, 1);
  EXPECT_NE(result.out.find("verdict different"), std::string::npos) << result.out;
  EXPECT_EQ(result.err, "");
}

TEST_F(CliCompare, HasNoVerdictWithoutErrorBars) {
  const auto result = run({"compare", writeNoisy("a.exr", 1, 0.3f, false), writeNoisy("b.exr", 2, 0), "--json"});
  EXPECT_EQ(result.exitCode, 0);
  EXPECT_FALSE(nlohmann::json::parse(result.out).contains("verdict"));
}

TEST_F(CliCompare, WritesAHeatmap) {
  const auto result =
      run({"compare", writeNoisy("a.exr", 1, 0.3f), writeNoisy("b.exr", 2, 0), "--heatmap", path("map.png").string()});
  EXPECT_EQ(result.exitCode, 1);
  EXPECT_TRUE(test::readBytes(path("map.png")).starts_with("\x89PNG"));
}

TEST_F(CliCompare, WritesDeviationsAsPlanesAndAsAPicture) {
  for (const char* name : {"z.exr", "z.png"}) {
    const auto result =
        run({"compare", writeNoisy("a.exr", 1, 0), writeNoisy("b.exr", 2, 0), "--z-map", path(name).string()});
    EXPECT_EQ(result.exitCode, 0) << result.err;
  }
  const Image z = readExr(path("z.exr"));
  double squares = 0;
  for (const char* name : {"z.R", "z.G", "z.B"}) {
    for (const float value : z.find(name)->values) squares += double(value) * double(value) / (3 * 1024);
  }
  // Error bars are exact here and taken for those of eight replicates: below 1 by the heavier tails of Student's t.
  EXPECT_NEAR(squares, 0.8, 0.1);
  EXPECT_TRUE(test::readBytes(path("z.png")).starts_with("\x89PNG"));
}

TEST_F(CliCompare, RefusesAZMapWithoutErrorBars) {
  const auto result =
      run({"compare", writeNoisy("a.exr", 1, 0, false), writeNoisy("b.exr", 2, 0), "--z-map", path("z.png").string()});
  EXPECT_EQ(result.exitCode, 2);
  expectOneErrorLine(result);
}

TEST_F(CliCompare, RefusesDifferentSizes) {
  writeExr(path("small.exr"), test::noiseImage(8, 8, {"R", "G", "B"}));
  const auto result = run({"compare", writeNoisy("a.exr", 1, 0), path("small.exr").string()});
  EXPECT_EQ(result.exitCode, 2);
  expectOneErrorLine(result);
}

TEST_F(CliCompare, ReportsNansAsNull) {
  Image image = test::noiseImage(8, 8, {"R", "G", "B"});
  image.channels[0].values[0] = NAN;
  writeExr(path("nan.exr"), image);
  const auto result = run({"compare", path("nan.exr").string(), path("nan.exr").string(), "--json"});
  EXPECT_EQ(result.exitCode, 0);
  EXPECT_TRUE(nlohmann::json::parse(result.out).at("relMSE").is_null());
}

} // namespace
} // namespace isophote
