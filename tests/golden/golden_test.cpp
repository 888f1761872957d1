// Test 66 of the reference list: golden images notice change, statistics decide whether it is wrong.
//
// Each scene's picture is kept as a small EXR with its standard errors. On the device and driver that made it the new
// picture should have the same bits; where it has not, the test says so with FLIP and relMSE, and fails only when the
// difference is more than the two pictures' own noise. ISOPHOTE_UPDATE_GOLDEN=1 writes the pictures anew.
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <iostream>
#include <set>

#include <gtest/gtest.h>

#include "isophote/compare.hpp"
#include "support/gpu_device.hpp"
#include "support/render.hpp"
#include "support/scenes.hpp"

namespace isophote::test {
namespace {

constexpr uint32_t kSize = 24;
// Few enough for a quick test, enough for standard errors on seven degrees of freedom in every pixel.
constexpr uint32_t kSamplesPerPixel = 64;

struct GoldenScene {
  const char* name;
  Scene (*scene)();
  Camera (*camera)();
};

Scene furnace() { return boxFurnace(glm::vec3(1), glm::vec3(0.5f)); }
Scene squareLight() { return squareLightOverFloor(2); }
Scene halfOpaqueLayers() { return alphaLayers(3, 0.5f); }
Camera floorCamera() { return lookAt({2, 2, 3}, {0, 0.3, 0}, 0.7); }
Camera layersCamera() { return orthographicLookAt({0, 0, 5}, {0, 0, 0}, 0.4, 0.4); }

const GoldenScene kScenes[] = {
    {"furnace", furnace, boxFurnaceCamera},
    {"square-light", squareLight, floorCamera},
    {"cornell-box", cornellBox, cornellCamera},
    {"material-spheres", materialSpheres, materialSpheresCamera},
    {"alpha-layers", halfOpaqueLayers, layersCamera},
    {"instance-grid", instanceGrid, instanceGridCamera},
    {"textured-still-life", texturedStillLife, texturedStillLifeCamera},
    {"punctual-still-life", punctualStillLife, punctualStillLifeCamera},
};

std::filesystem::path goldenFile(const GoldenScene& golden) {
  return std::filesystem::path(ISOPHOTE_SOURCE_DIR) / "tests/golden" / (std::string(golden.name) + ".exr");
}

Image renderGolden(const GoldenScene& golden) {
  Image image = renderImage(golden.scene(), golden.camera(), kSize, kSize, kSamplesPerPixel);
  const std::set<std::string> kept = {"R", "G", "B", "stderr.R", "stderr.G", "stderr.B"};
  std::erase_if(image.channels, [&](const Channel& channel) { return !kept.contains(channel.name); });
  image.attributes["isophote.device"] = gpuDevice().info().name + ", " + gpuDevice().info().driver;
  return image;
}

class Golden : public testing::TestWithParam<GoldenScene> {};

TEST_P(Golden, Test66PictureHasNotChangedByMoreThanItsNoise) {
  const Image image = renderGolden(GetParam());
  const std::filesystem::path file = goldenFile(GetParam());
  if (std::getenv("ISOPHOTE_UPDATE_GOLDEN") != nullptr) writeExr(file, image);
  const Image golden = readExr(file);
  const Comparison comparison = compareImages(image, golden);
  bool sameBits = true;
  for (const Channel& channel : image.channels) {
    const Channel* other = golden.find(channel.name);
    ASSERT_NE(other, nullptr) << channel.name;
    sameBits = sameBits && channel.values == other->values;
  }
  if (!sameBits) {
    std::cout << GetParam().name << " changed: FLIP " << comparison.flip << ", relMSE " << comparison.relMse
              << "; made on " << golden.attributes.at("isophote.device") << ", now "
              << image.attributes.at("isophote.device") << "\n";
  }
  ASSERT_TRUE(comparison.verdict.has_value());
  EXPECT_TRUE(comparison.verdict->same) << "p = " << comparison.verdict->p;
}

INSTANTIATE_TEST_SUITE_P(Scenes, Golden, testing::ValuesIn(kScenes), [](const auto& scene) {
  std::string name = scene.param.name;
  std::erase(name, '-');
  return name;
});

} // namespace
} // namespace isophote::test
