// Environment maps from Radiance HDR and OpenEXR.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "isophote/error.hpp"
#include "isophote/gltf.hpp"
#include "isophote/image.hpp"
#include "unit/gltf_asset.hpp"

using namespace isophote;
using namespace isophote::test;

namespace {

/// Uncompressed RGBE; `pixels` has four bytes each.
std::string hdr(int width, int height, const std::string& pixels) {
  return "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(height) + " +X " + std::to_string(width) + "\n" +
         pixels;
}

Environment loadHdr(const std::string& bytes, std::vector<std::string>& warnings) {
  const TemporaryFolder folder;
  return loadEnvironment(folder.write("sky.hdr", bytes), warnings);
}

Environment loadExr(uint32_t width, uint32_t height, const std::vector<float>& r, const std::vector<float>& g,
                    const std::vector<float>& b, std::vector<std::string>& warnings) {
  const TemporaryFolder folder;
  Image image;
  image.width = width;
  image.height = height;
  image.channels = {{"R", r}, {"G", g}, {"B", b}};
  writeExr(folder.path() / "sky.exr", image);
  return loadEnvironment(folder.path() / "sky.exr", warnings);
}

constexpr float kInfinity = std::numeric_limits<float>::infinity();

} // namespace

TEST(Environment, RadianceHdrIsDecoded) {
  std::vector<std::string> warnings;
  // mantissa * 2^(exponent - 136): 128 * 2^(129 - 136) = 1
  const Environment environment = loadHdr(hdr(2, 1, {"\x80\x40\x20\x81\xff\x00\x00\x8a", 8}), warnings);
  EXPECT_EQ(environment.width, 2u);
  EXPECT_EQ(environment.height, 1u);
  EXPECT_EQ(environment.pixels[0], glm::vec3(1, 0.5f, 0.25f));
  EXPECT_EQ(environment.pixels[1], glm::vec3(255 * 4, 0, 0));
  EXPECT_TRUE(warnings.empty());
}

TEST(Environment, OpenExrIsRead) {
  std::vector<std::string> warnings;
  const Environment environment = loadExr(2, 1, {1, 2}, {3, 4}, {5, 6e8f}, warnings);
  EXPECT_EQ(environment.pixels, (std::vector<glm::vec3>{{1, 3, 5}, {2, 4, 6e8f}}));
  EXPECT_TRUE(warnings.empty());
}

TEST(Environment, BadPixelsAreReplacedAndCounted) {
  std::vector<std::string> warnings;
  const Environment environment = loadExr(4, 2, {NAN, -1, kInfinity, 1, 1, 1, 1, 1}, {1, 1, 7, 1, 1, 1, 1, 1},
                                          {NAN, 1, 1, -kInfinity, 1, 1, 1, 1}, warnings);
  EXPECT_EQ(environment.pixels[0], glm::vec3(0, 1, 0));
  EXPECT_EQ(environment.pixels[1], glm::vec3(0, 1, 1));
  EXPECT_EQ(environment.pixels[2], glm::vec3(7, 7, 1)) << "the largest finite value of the map";
  EXPECT_EQ(environment.pixels[3], glm::vec3(1, 1, 0));
  ASSERT_EQ(warnings.size(), 3u);
  EXPECT_NE(warnings[0].find("1 pixels with NaN"), std::string::npos);
  EXPECT_NE(warnings[1].find("2 pixels with negative"), std::string::npos);
  EXPECT_NE(warnings[2].find("1 pixels with infinite"), std::string::npos);
}

TEST(Environment, AnotherShapeThanTwoToOneIsAWarning) {
  std::vector<std::string> warnings;
  EXPECT_EQ(loadExr(1, 2, {1, 2}, {1, 2}, {1, 2}, warnings).pixels.size(), 2u);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("twice as wide as high"), std::string::npos);
}

TEST(Environment, OnePixelIsAConstantSky) {
  std::vector<std::string> warnings;
  EXPECT_EQ(loadExr(1, 1, {2}, {3}, {4}, warnings).pixels, std::vector<glm::vec3>(1, glm::vec3(2, 3, 4)));
  EXPECT_TRUE(warnings.empty());
}
