// `isophote verify`: an image is what its header says, or the command says where it is not.
#include <nlohmann/json.hpp>

#include "unit/cli_fixture.hpp"

namespace isophote {
namespace {

class CliVerify : public test::CommandLineOnDevice {
protected:
  void SetUp() override {
    CommandLineOnDevice::SetUp();
    if (!IsSkipped()) scene_ = writeTriangle("triangle.gltf");
  }
  void render(const std::string& output, const std::vector<std::string>& flags) const {
    std::vector<std::string> arguments = {"render", scene_, "-o", file(output), "--width", "40", "--quiet"};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    const auto result = run(arguments);
    ASSERT_EQ(result.exitCode, 0) << result.err;
  }
  [[nodiscard]] test::CommandResult verify(const std::string& image, std::vector<std::string> flags = {}) const {
    flags.insert(flags.begin(), {"verify", file(image), "--quiet"});
    return run(flags);
  }
  [[nodiscard]] std::string file(const std::string& name) const { return path(name).string(); }

  /// Rewrites the image after `change`.
  template <class F> void alter(const std::string& name, F&& change) const {
    Image image = readExr(file(name));
    change(image);
    writeExr(file(name), image);
  }

  std::string scene_;
};

// Every flag that changes pixels has to come back from the header.
TEST_F(CliVerify, ImagesMatchBitForBitWhateverTheyWereAskedFor) {
  render("plain.exr", {"--spp", "9"});
  render("asked.exr", {"--spp",
                       "8",
                       "--crop",
                       "3,2,37,19",
                       "--sky",
                       "40,120",
                       "--env-intensity",
                       "0.3",
                       "--lens-radius",
                       "0.01",
                       "--focus-distance",
                       "2.7",
                       "--aperture-blades",
                       "5",
                       "--seed",
                       "18446744073709551615",
                       "--filter",
                       "gaussian",
                       "--set",
                       "clamp=0.1",
                       "--max-depth",
                       "3",
                       "--sampler",
                       "independent"});
  render("part.exr", {"--sample-range", "5:12", "--env-color", "0.1,0.2,0.7", "--panorama"});
  for (const char* name : {"plain.exr", "asked.exr", "part.exr"}) {
    const auto result = verify(name, {"--tiles", "100", "--json"});
    ASSERT_EQ(result.exitCode, 0) << name << result.err;
    const auto json = nlohmann::json::parse(result.out);
    EXPECT_EQ(json.at("verdict"), "bit for bit") << name;
    const Image image = readExr(file(name));
    EXPECT_EQ(json.at("pixels"), image.width * image.height) << name;
  }
}

TEST_F(CliVerify, OneAlteredPixelIsFound) {
  render("image.exr", {"--spp", "8"});
  alter("image.exr", [](Image& image) {
    for (Channel& channel : image.channels) {
      if (channel.name == "G") channel.values[7 * image.width + 23] += 1e-3f;
    }
  });
  const auto all = verify("image.exr", {"--tiles", "100"});
  EXPECT_EQ(all.exitCode, 1);
  expectOneErrorLine(all);
  EXPECT_NE(all.err.find("G of pixel 23,7"), std::string::npos) << all.err;
  EXPECT_NE(all.err.find("1 of 800 pixels"), std::string::npos) << all.err;
}

TEST_F(CliVerify, AnImageOfAnotherDeviceNeedsToMatchWithinItsErrorOnly) {
  render("image.exr", {"--spp", "64", "--env-color", "1,1,1"});
  const auto fromElsewhere = [&](float factor) {
    alter("image.exr", [&](Image& image) {
      image.attributes["isophote.device"] = "another one, 1.0";
      for (Channel& channel : image.channels) {
        if (channel.name == "R" || channel.name == "G" || channel.name == "B")
          for (float& value : channel.values) value *= factor;
      }
    });
  };
  fromElsewhere(1 + 1e-6f);
  const auto close = run({"verify", file("image.exr"), "--tiles", "100", "--json"});
  EXPECT_EQ(close.exitCode, 0) << close.err;
  EXPECT_NE(close.err.find("another one"), std::string::npos);
  EXPECT_EQ(nlohmann::json::parse(close.out).at("verdict"), "within error");
  fromElsewhere(2);
  EXPECT_EQ(verify("image.exr", {"--tiles", "100"}).exitCode, 1);
}

TEST_F(CliVerify, RefusesImagesWithoutAReceiptAndScenesThatHaveChanged) {
  render("image.exr", {"--spp", "4"});
  std::filesystem::copy_file(file("image.exr"), file("bare.exr"));
  std::filesystem::copy_file(file("image.exr"), file("odd.exr"));
  alter("bare.exr", [](Image& image) { image.attributes.erase("isophote.settings"); });
  alter("odd.exr", [](Image& image) { image.attributes["isophote.settings"] = R"({"image": 3})"; });
  for (const char* name : {"bare.exr", "odd.exr"}) {
    const auto refused = verify(name);
    EXPECT_EQ(refused.exitCode, 2) << name;
    expectOneErrorLine(refused);
  }
  (void)writeTriangle("triangle.gltf", R"("extras": 1,)");
  const auto changed = verify("image.exr");
  EXPECT_EQ(changed.exitCode, 2);
  EXPECT_NE(changed.err.find("has changed"), std::string::npos) << changed.err;
  expectOneErrorLine(changed);
}

} // namespace
} // namespace isophote
