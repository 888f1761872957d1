// --backend on the command line, and what images and stats say of it.
#include <nlohmann/json.hpp>

#include "isophote/device.hpp"
#include "unit/cli_fixture.hpp"

namespace isophote {
namespace {

using Json = nlohmann::json;

class CliBackend : public test::CommandLineOnDevice {
protected:
  void SetUp() override {
    CommandLineOnDevice::SetUp();
    if (IsSkipped()) return;
    const Json list = Json::parse(run({"devices", "--json"}).out);
    for (const Json& device : list.at("devices")) {
      if (device.at("usable").get<bool>() && device.at("ray_query").get<bool>()) return;
    }
    GTEST_SKIP() << "no device here has VK_KHR_ray_query";
  }

  [[nodiscard]] std::string file(const std::string& name) const { return path(name).string(); }
};

} // namespace

TEST_F(CliBackend, RayQueryStandsInStatsAndReceiptAndIsVerified) {
  const std::string scene = writeTriangle("triangle.gltf");
  const auto rendered = run({"render", scene, "-o", file("a.exr"), "--width", "40", "--spp", "8", "--quiet",
                             "--backend", "ray-query", "--validation", "--stats", file("a.json")});
  ASSERT_EQ(rendered.exitCode, 0) << rendered.err;
  const Json stats = Json::parse(test::readBytes(file("a.json")));
  EXPECT_EQ(stats.at("backend"), "ray-query");
  EXPECT_EQ(stats.at("bvh").at("nodes"), 0);
  const auto settings = Json::parse(readExr(file("a.exr")).attributes.at("isophote.settings"));
  EXPECT_EQ(settings.at("backend"), "ray-query");
  const auto verified = run({"verify", file("a.exr"), "--quiet"});
  EXPECT_EQ(verified.exitCode, 0) << verified.err;
}

TEST_F(CliBackend, AnUnknownOneIsRefused) {
  const auto result = run({"render", writeTriangle("triangle.gltf"), "-o", file("a.exr"), "--backend", "embree"});
  EXPECT_EQ(result.exitCode, 2);
  expectOneErrorLine(result);
  EXPECT_NE(result.err.find("ray-query"), std::string::npos) << result.err;
}

} // namespace isophote
