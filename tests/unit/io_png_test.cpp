#include <limits>

#include <stb/stb_image.h>

#include "isophote/error.hpp"
#include "unit/io_fixture.hpp"

namespace isophote {
namespace {

class Png : public test::InTemporaryFolder {};

struct Decoded {
  int width = 0, height = 0, components = 0;
  std::vector<uint8_t> bytes;
};

Decoded decode(const std::filesystem::path& file) {
  Decoded image;
  uint8_t* pixels = stbi_load(file.c_str(), &image.width, &image.height, &image.components, 0);
  if (pixels == nullptr) return image;
  image.bytes.assign(pixels, pixels + image.width * image.height * image.components);
  stbi_image_free(pixels);
  return image;
}

Image colorImage(uint32_t width, uint32_t height, glm::vec3 color) {
  Image image;
  image.width = width;
  image.height = height;
  const size_t pixels = size_t(width) * height;
  image.channels = {{"R", std::vector<float>(pixels, color.r)},
                    {"G", std::vector<float>(pixels, color.g)},
                    {"B", std::vector<float>(pixels, color.b)}};
  return image;
}

TEST_F(Png, WritesRoundedToneMappedPixelsWithTheTopRowFirst) {
  Image image = colorImage(3, 2, {0.2f, 0.5f, 0.7f});
  image.channels[0].values[0] = 1.0f; // top left
  writePng(path("a.png"), image, 0, ToneMap::Srgb);
  const Decoded png = decode(path("a.png"));
  ASSERT_EQ(png.width, 3);
  ASSERT_EQ(png.height, 2);
  ASSERT_EQ(png.components, 3);
  EXPECT_EQ(png.bytes[0], 255);
  // sRGB of 0.2, 0.5, 0.7: 0.484529, 0.735357, 0.854306, times 255
  for (size_t pixel = 1; pixel < 6; ++pixel) {
    EXPECT_EQ(png.bytes[pixel * 3], 124);
    EXPECT_EQ(png.bytes[pixel * 3 + 1], 188);
    EXPECT_EQ(png.bytes[pixel * 3 + 2], 218);
  }
}

TEST_F(Png, ExposureIsInStops) {
  writePng(path("a.png"), colorImage(1, 1, {0.25f, 0.125f, 0.0625f}), 1, ToneMap::Linear);
  const Decoded png = decode(path("a.png"));
  EXPECT_EQ(png.bytes, (std::vector<uint8_t>{128, 64, 32}));
}

TEST_F(Png, AlphaIsUnassociated) {
  Image image = colorImage(2, 1, {0.25f, 0.25f, 0.25f});
  image.channels.push_back({"A", {0.5f, 0.0f}});
  writePng(path("a.png"), image, 0, ToneMap::Linear);
  const Decoded png = decode(path("a.png"));
  ASSERT_EQ(png.components, 4);
  EXPECT_EQ(png.bytes, (std::vector<uint8_t>{128, 128, 128, 128, 64, 64, 64, 0}));
}

TEST_F(Png, SurvivesNansInfinitiesAndNegatives) {
  Image image = colorImage(4, 1, {0, 0, 0});
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  for (Channel& channel : image.channels) channel.values = {nan, infinity, -infinity, -1};
  image.channels.push_back({"A", {nan, 1, 1, infinity}});
  for (const ToneMap operation : {ToneMap::Neutral, ToneMap::Agx, ToneMap::Aces, ToneMap::Srgb, ToneMap::Linear}) {
    writePng(path("a.png"), image, 0, operation);
    const Decoded png = decode(path("a.png"));
    ASSERT_EQ(png.bytes.size(), 16u);
    EXPECT_EQ(png.bytes[0], 0);
    EXPECT_GE(png.bytes[4], 250);
    EXPECT_EQ(png.bytes[8], 0);
    EXPECT_EQ(png.bytes[12], 0);
  }
}

TEST_F(Png, NeedsColor) {
  EXPECT_THROW(writePng(path("a.png"), test::noiseImage(2, 2, {"R", "G"}), 0, ToneMap::Srgb), UsageError);
}

TEST_F(Png, SaysThatTooManyPixelsDoNotFit) {
  Image image;
  image.width = 65535;
  image.height = 65535;
  image.channels = {{"R", {}}, {"G", {}}, {"B", {}}};
  EXPECT_THROW(writePng(path("a.png"), image, 0, ToneMap::Srgb), OutputError);
}

} // namespace
} // namespace isophote
