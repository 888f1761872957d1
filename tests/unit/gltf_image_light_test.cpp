// EXT_lights_image_based: which texel of which face comes from where.
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "isophote/error.hpp"
#include "unit/gltf_asset.hpp"
#include "unit/gltf_png.hpp"

namespace isophote {
namespace {

constexpr double kPi = 3.14159265358979323846;

std::string pixel(int r, int g, int b, int a = 255) {
  std::string bytes;
  for (const int value : {r, g, b, a}) bytes += static_cast<char>(value);
  return bytes;
}

/// A face of `size` x `size` texels of one color.
std::string plain(uint32_t size, const std::string& texel) {
  std::string rows;
  for (uint32_t i = 0; i < size * size; ++i) rows += texel;
  return test::png({.width = size, .height = size, .rows = rows});
}

struct CubeAsset {
  test::GltfAsset asset = test::triangleAsset();
  test::TemporaryFolder folder;

  explicit CubeAsset(const std::array<std::string, 6>& faces, uint32_t size) {
    test::Json level = test::Json::array();
    for (const std::string& face : faces) level.push_back(asset.addImage(face));
    const test::Json coefficients(9, {0, 0, 0});
    asset.json["extensionsUsed"] = {"EXT_lights_image_based"};
    asset.json["extensions"]["EXT_lights_image_based"]["lights"] = {
        {{"irradianceCoefficients", coefficients}, {"specularImages", {level}}, {"specularImageSize", size}}};
    asset.json["scenes"][0]["extensions"]["EXT_lights_image_based"]["light"] = 0;
  }
  test::Json& light() { return asset.json["extensions"]["EXT_lights_image_based"]["lights"][0]; }
  Scene load() { return loadGltf(folder.write("a.gltf", asset.gltf())); }
  /// The pointer of the error that loading gives.
  std::string refusal() {
    try {
      (void)load();
    } catch (const SceneError& error) {
      return error.what();
    }
    return "nothing was refused";
  }
};

/// The map's texel at a direction.
glm::vec3 from(const Environment& map, glm::dvec3 d) {
  d = glm::normalize(d);
  const double u = 0.5 + std::atan2(d.x, -d.z) / (2 * kPi);
  const double v = std::acos(d.y) / kPi;
  const auto column = std::min(static_cast<uint32_t>(u * map.width), map.width - 1);
  const auto row = std::min(static_cast<uint32_t>(v * map.height), map.height - 1);
  return map.pixels[size_t{row} * map.width + column];
}

const glm::dvec3 kAxes[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};

/// Faces that differ: +x red, -x green, +y blue, -y yellow, +z cyan, -z magenta.
std::array<std::string, 6> sixColors(uint32_t size) {
  return {plain(size, pixel(255, 0, 0)),   plain(size, pixel(0, 255, 0)),   plain(size, pixel(0, 0, 255)),
          plain(size, pixel(255, 255, 0)), plain(size, pixel(0, 255, 255)), plain(size, pixel(255, 0, 255))};
}
const glm::vec3 kColors[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {0, 1, 1}, {1, 0, 1}};

TEST(GltfImageLight, EachFaceLiesInItsDirection) {
  CubeAsset cube(sixColors(4), 4);
  cube.light()["intensity"] = 2.5;
  const Scene scene = cube.load();
  ASSERT_TRUE(scene.environment);
  EXPECT_EQ(scene.environment->intensity, 2.5f);
  EXPECT_EQ(scene.environment->width, 16u);
  EXPECT_EQ(scene.environment->height, 8u);
  EXPECT_TRUE(scene.warnings.empty());
  for (int i = 0; i < 6; ++i) EXPECT_EQ(from(*scene.environment, kAxes[i]), kColors[i]) << i;
}

// Seen from inside, each side face has its first row at +y and its columns from left to right.
TEST(GltfImageLight, SideFacesStandUprightAsSeenFromInside) {
  constexpr uint32_t kSize = 8;
  for (const int face : {0, 1, 4, 5}) {
    std::string rows;
    for (uint32_t row = 0; row < kSize; ++row) {
      for (uint32_t column = 0; column < kSize; ++column) {
        rows += pixel(row < kSize / 2 ? 255 : 0, column >= kSize / 2 ? 255 : 0, 0);
      }
    }
    auto faces = sixColors(kSize);
    faces[static_cast<size_t>(face)] = test::png({.width = kSize, .height = kSize, .rows = rows});
    CubeAsset cube(faces, kSize);
    const Environment map = *cube.load().environment;
    const glm::dvec3 forward = kAxes[face];
    const glm::dvec3 up(0, 1, 0);
    const glm::dvec3 right = glm::cross(forward, up);
    EXPECT_EQ(from(map, forward + 0.6 * up + 0.6 * right), glm::vec3(1, 1, 0)) << face;
    EXPECT_EQ(from(map, forward + 0.6 * up - 0.6 * right), glm::vec3(1, 0, 0)) << face;
    EXPECT_EQ(from(map, forward - 0.6 * up + 0.6 * right), glm::vec3(0, 1, 0)) << face;
    EXPECT_EQ(from(map, forward - 0.6 * up - 0.6 * right), glm::vec3(0, 0, 0)) << face;
  }
}

// The first row of +y borders on the top of -z.
TEST(GltfImageLight, TopAndBottomMeetTheSides) {
  constexpr uint32_t kSize = 8;
  std::string rows;
  for (uint32_t row = 0; row < kSize; ++row) {
    for (uint32_t column = 0; column < kSize; ++column)
      rows += pixel(row < kSize / 2 ? 255 : 0, column < kSize / 2 ? 255 : 0, 0);
  }
  auto faces = sixColors(kSize);
  faces[2] = faces[3] = test::png({.width = kSize, .height = kSize, .rows = rows});
  const Environment map = *CubeAsset(faces, kSize).load().environment;
  // OpenGL: (s, t) of +y are (x, z), of -y (x, -z); the stored images are mirrored in s.
  EXPECT_EQ(from(map, {0.5, 1, -0.5}), glm::vec3(1, 1, 0));
  EXPECT_EQ(from(map, {-0.5, 1, -0.5}), glm::vec3(1, 0, 0));
  EXPECT_EQ(from(map, {0.5, 1, 0.5}), glm::vec3(0, 1, 0));
  EXPECT_EQ(from(map, {0.5, -1, 0.5}), glm::vec3(1, 1, 0));
  EXPECT_EQ(from(map, {-0.5, -1, -0.5}), glm::vec3(0, 0, 0));
}

TEST(GltfImageLight, RotationTurnsTheMapFromItsSpaceToTheWorlds) {
  CubeAsset cube(sixColors(4), 4);
  cube.light()["rotation"] = {0, std::sqrt(0.5), 0, std::sqrt(0.5)}; // 90 degrees about y: +z to +x
  const Environment map = *cube.load().environment;
  EXPECT_EQ(from(map, {1, 0, 0}), kColors[4]);
  EXPECT_EQ(from(map, {0, 0, 1}), kColors[1]);
  EXPECT_EQ(from(map, {0, 1, 0}), kColors[2]);
}

TEST(GltfImageLight, ColorsAreSrgbOverAlpha) {
  auto faces = sixColors(8); // with fewer, the map's texel at +x reaches into other faces
  faces[0] = plain(8, pixel(255, 188, 0, 51));
  const Environment map = *CubeAsset(faces, 8).load().environment;
  const glm::vec3 color = from(map, {1, 0, 0});
  EXPECT_NEAR(color.r, 5, 1e-5);
  EXPECT_NEAR(color.g, 5 * std::pow((188 / 255.0 + 0.055) / 1.055, 2.4), 1e-5);
  EXPECT_EQ(color.b, 0);
}

TEST(GltfImageLight, AnotherSceneHasNone) {
  CubeAsset cube(sixColors(2), 2);
  cube.asset.json["scenes"].push_back({{"nodes", {0}}});
  cube.asset.json["scene"] = 1;
  EXPECT_FALSE(cube.load().environment);
}

TEST(GltfImageLight, BrokenDataIsRefusedWithItsPlace) {
  const std::string light = "/extensions/EXT_lights_image_based/lights/0";
  const auto refusalOf = [](const auto& change) {
    CubeAsset cube(sixColors(2), 2);
    change(cube);
    return cube.refusal();
  };
  using testing::IsSubstring;
  EXPECT_PRED_FORMAT2(IsSubstring, light + "/specularImages/0",
                      refusalOf([](CubeAsset& cube) { cube.light()["specularImages"][0].erase(5); }));
  EXPECT_PRED_FORMAT2(IsSubstring, light + "/specularImages/0/3",
                      refusalOf([](CubeAsset& cube) { cube.light()["specularImages"][0][3] = 99; }));
  EXPECT_PRED_FORMAT2(IsSubstring, light,
                      refusalOf([](CubeAsset& cube) { cube.light().erase("irradianceCoefficients"); }));
  EXPECT_PRED_FORMAT2(IsSubstring, light + "/rotation", refusalOf([](CubeAsset& cube) {
                        cube.light()["rotation"] = {0, 0, 0, 0};
                      }));
  EXPECT_PRED_FORMAT2(IsSubstring, "/scenes/0/extensions/EXT_lights_image_based/light", refusalOf([](CubeAsset& cube) {
                        cube.asset.json["scenes"][0]["extensions"]["EXT_lights_image_based"]["light"] = 1;
                      }));
  auto faces = sixColors(2);
  faces[4] = plain(4, pixel(1, 2, 3));
  EXPECT_PRED_FORMAT2(IsSubstring, light + "/specularImages/0/4", CubeAsset(faces, 2).refusal());
  faces[4] = test::png({.width = 2, .height = 1, .rows = pixel(1, 2, 3) + pixel(1, 2, 3)});
  EXPECT_PRED_FORMAT2(IsSubstring, light + "/specularImages/0/4", CubeAsset(faces, 2).refusal());
}

} // namespace
} // namespace isophote
