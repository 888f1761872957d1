#include <bit>
#include <cstring>
#include <limits>

#include "isophote/error.hpp"
#include "unit/io_fixture.hpp"

namespace isophote {
namespace {

using test::noiseImage;
using test::readBytes;
using test::writeBytes;

class Exr : public test::InTemporaryFolder {};

void expectSameBits(const std::vector<float>& a, const std::vector<float>& b) {
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(float)), 0);
}

TEST_F(Exr, RoundTripsEveryBitAtOddSizes) {
  for (const auto& [width, height] : {std::pair{1u, 1u}, {7u, 3u}, {1u, 1000u}, {1000u, 1u}, {67u, 131u}}) {
    const Image image =
        noiseImage(width, height, {"R", "G", "B", "A", "stderr.R", "normal.X", "depth.Z", "sampleCount.Y"});
    writeExr(path("a.exr"), image);
    const Image read = readExr(path("a.exr"));
    ASSERT_EQ(read.width, width);
    ASSERT_EQ(read.height, height);
    ASSERT_EQ(read.channels.size(), image.channels.size());
    for (const Channel& channel : image.channels) {
      ASSERT_NE(read.find(channel.name), nullptr) << channel.name;
      expectSameBits(read.find(channel.name)->values, channel.values);
    }
  }
}

TEST_F(Exr, KeepsInfinitiesNansNegativesAndDenormals) {
  Image image = noiseImage(3, 2, {"R"});
  image.channels[0].values = {std::numeric_limits<float>::infinity(),
                              -std::numeric_limits<float>::infinity(),
                              std::numeric_limits<float>::quiet_NaN(),
                              -0.0f,
                              1e-45f,
                              -3.4e38f};
  writeExr(path("a.exr"), image);
  expectSameBits(readExr(path("a.exr")).channels[0].values, image.channels[0].values);
}

TEST_F(Exr, KeepsAttributesAndRenderTime) {
  Image image = noiseImage(2, 2, {"R", "G", "B"});
  image.attributes = {{"isophote.seed", "18446744073709551615"}, {"isophote.settings", R"({"a": "b"})"}, {"empty", ""}};
  image.renderSeconds = 12.5f;
  writeExr(path("a.exr"), image);
  const Image read = readExr(path("a.exr"));
  for (const auto& [name, text] : image.attributes) {
    ASSERT_TRUE(read.attributes.contains(name)) << name;
    EXPECT_EQ(read.attributes.at(name), text);
  }
  EXPECT_EQ(read.renderSeconds, 12.5f);
}

TEST_F(Exr, StatesCompressionPrimariesAndWhite) {
  writeExr(path("a.exr"), noiseImage(2, 2, {"R"}));
  const std::string bytes = readBytes(path("a.exr"));
  const auto attribute = [&](const std::string& name, const std::string& type) {
    const size_t at = bytes.find(name + '\0' + type + '\0');
    EXPECT_NE(at, std::string::npos) << name;
    return bytes.data() + at + name.size() + type.size() + 2 + sizeof(uint32_t);
  };
  EXPECT_EQ(*attribute("compression", "compression"), 3); // ZIP, 16 lines a block
  float value[8];
  std::memcpy(value, attribute("chromaticities", "chromaticities"), sizeof(value));
  const float rec709[8] = {0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};
  for (int i = 0; i < 8; ++i) EXPECT_FLOAT_EQ(value[i], rec709[i]);
  std::memcpy(value, attribute("whiteLuminance", "float"), sizeof(float));
  EXPECT_EQ(value[0], 1.0f);
}

TEST_F(Exr, RefusesAnEnormousHeaderBeforeAllocating) {
  writeExr(path("a.exr"), noiseImage(2, 2, {"R"}));
  const std::string good = readBytes(path("a.exr"));
  const std::string key = std::string("dataWindow") + '\0' + "box2i" + '\0';
  const size_t at = good.find(key) + key.size() + sizeof(uint32_t);
  const int32_t big = std::numeric_limits<int32_t>::max();
  for (const auto& box :
       {std::array<int32_t, 4>{0, 0, (1 << 17) - 1, (1 << 17) - 1}, {0, 0, big, big}, {-big, -big, big, big}}) {
    std::string bytes = good;
    std::memcpy(bytes.data() + at, box.data(), sizeof(box));
    writeBytes(path("b.exr"), bytes);
    EXPECT_THROW((void)readExr(path("b.exr")), LimitError);
  }
  const std::array<int32_t, 4> empty{0, 0, -1, -1};
  std::string bytes = good;
  std::memcpy(bytes.data() + at, empty.data(), sizeof(empty));
  writeBytes(path("b.exr"), bytes);
  EXPECT_THROW((void)readExr(path("b.exr")), SceneError);
}

TEST_F(Exr, RefusesEveryTruncation) {
  writeExr(path("a.exr"), noiseImage(5, 40, {"R", "G"}));
  const std::string good = readBytes(path("a.exr"));
  for (size_t length = 0; length < good.size(); length += length < 400 ? 1 : 29) {
    writeBytes(path("b.exr"), good.substr(0, length));
    EXPECT_THROW((void)readExr(path("b.exr")), SceneError) << length;
  }
}

TEST_F(Exr, SurvivesDamagedBytes) {
  writeExr(path("a.exr"), noiseImage(5, 40, {"R", "G"}));
  const std::string good = readBytes(path("a.exr"));
  std::mt19937 random(1);
  int refused = 0;
  for (int i = 0; i < 400; ++i) {
    std::string bytes = good;
    const size_t at = random() % (i % 2 == 0 ? 360 : bytes.size()); // half of the damage goes to the header
    bytes[at] = static_cast<char>(random());
    writeBytes(path("b.exr"), bytes);
    try {
      (void)readExr(path("b.exr"));
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 50);
}

// OpenEXR would make memory of that size.
TEST_F(Exr, RefusesAttributesLongerThanTheFile) {
  Image image = noiseImage(5, 4, {"R"});
  image.attributes["comment"] = "text";
  writeExr(path("a.exr"), image);
  std::string bytes = readBytes(path("a.exr"));
  const std::string type("comment\0string\0", 15);
  const size_t at = bytes.find(type) + type.size();
  ASSERT_EQ(bytes.substr(at, 8), std::string("\4\0\0\0text", 8));
  for (const std::string& size : {std::string("\xff\xff\xff\x7f", 4), std::string("\xff\xff\xff\xff", 4)}) {
    writeBytes(path("b.exr"), bytes.replace(at, 4, size));
    try {
      (void)readExr(path("b.exr"));
      FAIL();
    } catch (const SceneError& error) {
      EXPECT_NE(std::string(error.what()).find("longer than the file"), std::string::npos) << error.what();
    }
  }
}

// OpenEXR reads on where a value ended, and would take the bytes behind it for the size of the next one.
TEST_F(Exr, RefusesAttributesOfAnotherSizeThanTheirValue) {
  Image image = noiseImage(5, 4, {"R"});
  image.renderSeconds = 1;
  writeExr(path("a.exr"), image);
  const std::string whole = readBytes(path("a.exr"));
  for (const std::string& type : {std::string("renderTime\0float\0", 17), std::string("channels\0chlist\0", 16),
                                  std::string("compression\0compression\0", 24)}) {
    const size_t at = whole.find(type) + type.size();
    ASSERT_LT(at, whole.size());
    for (const int off : {-1, 1, 16}) {
      std::string bytes = whole;
      bytes[at] = static_cast<char>(bytes[at] + off);
      writeBytes(path("b.exr"), bytes);
      try {
        (void)readExr(path("b.exr"));
        ADD_FAILURE() << type << off;
      } catch (const SceneError& error) {
        EXPECT_NE(std::string(error.what()).find("has not the size"), std::string::npos) << error.what();
      }
    }
  }
}

TEST_F(Exr, NamesWhatCannotBeRead) {
  writeBytes(path("text.exr"), "this is not an image, but long enough for one");
  for (const char* name : {"absent.exr", "text.exr", "."}) {
    try {
      (void)readExr(path(name));
      FAIL() << name;
    } catch (const SceneError& error) {
      EXPECT_NE(std::string(error.what()).find(path(name).string()), std::string::npos) << error.what();
    }
  }
}

TEST_F(Exr, RefusesImagesThatAreNotWhole) {
  Image image = noiseImage(4, 4, {"R", "G"});
  image.channels[1].values.pop_back();
  EXPECT_THROW(writeExr(path("a.exr"), image), UsageError);
  EXPECT_THROW(writeExr(path("a.exr"), Image{}), UsageError);
  EXPECT_THROW(writeExr(path("a.exr"), noiseImage(2, 2, {"R", "R"})), UsageError);
  EXPECT_THROW(writeExr(path("a.exr"), noiseImage(2, 2, {})), UsageError);
  EXPECT_EQ(fileCount(), 0u);
}

} // namespace
} // namespace isophote
