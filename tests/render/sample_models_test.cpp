// Every model of the shared collection loads and renders, or is refused for a documented reason.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "isophote/error.hpp"
#include "isophote/gltf.hpp"
#include "support/paths.hpp"
#include "support/render.hpp"
#include "support/scenes.hpp"

namespace isophote {
namespace {

using namespace isophote::test;

std::vector<std::filesystem::path> modelFiles(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const auto extension = entry.path().extension();
    if (entry.is_regular_file() && (extension == ".gltf" || extension == ".glb")) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// Stored by a large-file extension as a text pointer: not the model itself.
bool isPointer(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  return line.rfind("version https://git-lfs", 0) == 0;
}

void expectFinite(const Image& image) {
  for (const char* name : {"R", "G", "B", "A", "depth.Z"}) {
    for (const float value : plane(image, name)) ASSERT_TRUE(std::isfinite(value)) << name;
  }
}

TEST(RenderSampleModels, Test57EveryModelRendersFiniteAndHealthyOrIsRefused) {
  const auto shared = sharedFolder();
  if (!shared || !std::filesystem::is_directory(*shared / "gltf"))
    GTEST_SKIP() << "no sample models beside the checkout";
  uint32_t rendered = 0, refused = 0, absent = 0;
  for (const auto& file : modelFiles(*shared / "gltf")) {
    SCOPED_TRACE(file.filename().string());
    if (isPointer(file)) {
      ++absent;
      continue;
    }
    try {
      Scene scene = loadGltf(file);
      if (scene.lights.empty() && !scene.environment) scene.environment = constantEnvironment(glm::vec3(1));
      const Camera camera = scene.cameras.empty() ? framingCamera(scene, 1.5) : scene.cameras.front();
      expectFinite(renderImage(scene, camera, 48, 32, 4));
      ++rendered;
    } catch (const UnsupportedError& error) { // a required extension that this build does not know
      EXPECT_NE(std::string(error.what()).find("xtension"), std::string::npos) << error.what();
      ++refused;
    }
  }
  RecordProperty("rendered", static_cast<int>(rendered));
  RecordProperty("refused", static_cast<int>(refused));
  RecordProperty("absent", static_cast<int>(absent));
  EXPECT_GT(rendered, 0u);
  EXPECT_GT(rendered, refused);
}

// The same man and the same grid, plain, quantized, packed by meshopt and by Draco. What quantization may move: 11 bits
// of the model's size, 1/2048, which is up to 2% of a pixel of 1/48 here, so 2% of the contrast of 1 along an edge.
TEST(RenderSampleModels, EveryFormOfAModelRendersAlike) {
  const auto shared = sharedFolder();
  if (!shared) GTEST_SKIP() << "no sample models beside the checkout";
  const std::vector<std::vector<std::string>> models = {
      {"CesiumMan/CesiumMan.glb", "CesiumMan/CesiumMan-embedded.gltf", "CesiumMan/CesiumMan-quantized.glb",
       "CesiumMan/CesiumMan-meshopt-c.glb", "CesiumMan/CesiumMan-meshopt-cc.glb", "CesiumMan/CesiumMan-draco.glb"},
      {"MorphStressTest/morph-stress-test.glb", "MorphStressTest/morph-stress-test-embedded.gltf",
       "MorphStressTest/sep_morph-stress-test.gltf", "MorphStressTest/morph-stress-test-quantized.glb",
       "MorphStressTest/morph-stress-test-meshopt-c.glb", "MorphStressTest/morph-stress-test-meshopt-cc.glb",
       "MorphStressTest/morph-stress-test-draco.glb"}};
  for (const auto& forms : models) {
    std::optional<Camera> camera;
    MeasuredImage reference;
    for (const std::string& form : forms) {
      SCOPED_TRACE(form);
      Scene scene = loadGltf(*shared / "gltf" / form);
      scene.environment = constantEnvironment(glm::vec3(1));
      if (!camera) camera = framingCamera(scene, 1);
      const MeasuredImage image = measured(renderImage(scene, *camera, 48, 48, 64));
      if (reference.pixels.empty()) {
        reference = image;
      } else {
        EXPECT_TRUE(sameImage(image, reference, {.absoluteTolerance = 0.03, .powerFloor = 0.01}));
      }
    }
  }
}

} // namespace
} // namespace isophote
