#include <nlohmann/json.hpp>

#include "unit/cli_fixture.hpp"

namespace isophote {
namespace {

class CliInfo : public test::CommandLine {};

bool contains(const nlohmann::json& list, const std::string& text) {
  return std::find(list.begin(), list.end(), text) != list.end();
}

TEST_F(CliInfo, CountsWhatATriangleSceneHolds) {
  const auto result = run({"info", "--json", writeTriangle("triangle.gltf")});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json.at("schema"), 1);
  const auto& content = json.at("content");
  EXPECT_EQ(content.at("triangles"), 1);
  EXPECT_EQ(content.at("instanced_triangles"), 1);
  EXPECT_EQ(content.at("emissive_triangles"), 0);
  EXPECT_EQ(content.at("cameras"), 1);
  EXPECT_EQ(content.at("punctual_lights"), 1);
  EXPECT_EQ(content.at("textures"), 0);
  EXPECT_EQ(json.at("bounds").at("upper"), nlohmann::json({1.0, 1.0, 0.0}));
  EXPECT_EQ(json.at("cameras").at(0).at("name"), "front");
  EXPECT_EQ(json.at("lights").at(0).at("kind"), "point");
  EXPECT_TRUE(contains(json.at("extensions_used"), "KHR_lights_punctual"));
  EXPECT_GE(json.at("memory_estimate").at("total_bytes"), 36);
}

TEST_F(CliInfo, EveryFeatureIsEitherNeededOrLeftOut) {
  const auto result = run({"info", "--json", writeTriangle("triangle.gltf")});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_TRUE(contains(json.at("features"), "punctual-lights"));
  bool textures = false;
  for (const auto& entry : json.at("left_out")) {
    EXPECT_FALSE(contains(json.at("features"), entry.at("feature"))) << entry;
    EXPECT_FALSE(entry.at("omitted").get<std::string>().empty());
    textures = textures || entry.at("feature") == "textures";
  }
  EXPECT_TRUE(textures);
  const auto lit = run({"info", "--json", path("triangle.gltf").string(), "--env-color", "1,1,1"});
  EXPECT_TRUE(contains(nlohmann::json::parse(lit.out).at("features"), "environment"));
}

TEST_F(CliInfo, SaysTheSameInText) {
  const auto result = run({"info", writeTriangle("triangle.gltf")});
  EXPECT_EQ(result.exitCode, 0);
  for (const char* text :
       {"1 triangles", "camera 0 'front', perspective", "point light 'lamp'", "left out", "textures"}) {
    EXPECT_NE(result.out.find(text), std::string::npos) << text << " in\n" << result.out;
  }
  EXPECT_EQ(result.out.find("no light"), std::string::npos);
}

TEST_F(CliInfo, RefusesUnknownRequiredExtensionsWithFour) {
  const auto result = run({"info", writeTriangle("triangle.gltf", R"("extensionsRequired": ["EXT_from_tomorrow"],)")});
  EXPECT_EQ(result.exitCode, 4) << result.err;
  EXPECT_NE(result.err.find("EXT_from_tomorrow"), std::string::npos);
  expectOneErrorLine(result);
}

TEST_F(CliInfo, RefusesABrokenAssetWithThreeAndItsPointer) {
  const std::string scene = writeTriangle("triangle.gltf");
  std::filesystem::resize_file(path("triangle.bin"), 20);
  const auto result = run({"info", scene});
  EXPECT_EQ(result.exitCode, 3) << result.err;
  EXPECT_NE(result.err.find(scene + ": /buffers/0"), std::string::npos) << result.err;
  expectOneErrorLine(result);
}

} // namespace
} // namespace isophote
