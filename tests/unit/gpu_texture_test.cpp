#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "gpu/device_impl.hpp"
#include "gpu/texture_array.hpp"
#include "gpu/texture_pixels.hpp"
#include "isophote/error.hpp"
#include "support/gpu_device.hpp"
#include "support/probe.hpp"
#include "test_unit_kernels.hpp"
#include "unit/gpu_case.h"
#include "unit/gpu_own_device.hpp"

using namespace isophote;
using gpu::TextureArray;
using gpu::TextureCase;
using gpu::TextureResult;
using gpu::TextureUpload;

namespace {

ImageData image(uint32_t width, uint32_t height, uint32_t bits, const std::vector<uint32_t>& values) {
  ImageData result{.name = "made", .width = width, .height = height, .bitsPerChannel = bits};
  for (const uint32_t value : values) {
    result.pixels.push_back(static_cast<std::byte>(value & 0xff));
    if (bits == 16) result.pixels.push_back(static_cast<std::byte>(value >> 8));
  }
  return result;
}

/// Red = 0, 51, 102, ... along the row, alpha 255.
ImageData ramp(uint32_t width) {
  std::vector<uint32_t> values;
  for (uint32_t x = 0; x < width; ++x) values.insert(values.end(), {51 * x, 0, 0, 255});
  return image(width, 1, 8, values);
}

std::vector<TextureResult> read(const TextureArray& textures, const std::vector<TextureCase>& cases) {
  const auto& kernel = test_unit_kernels::kernelSource("gpu_texture_probe");
  return test::runProbe<TextureCase, TextureResult>(kernel, cases, test::ProbeEnvironment{.textures = &textures});
}

/// Between neighbors 0.2 apart: one step of an 8-bit filter weight, the least precision that Vulkan allows.
constexpr float kFilterTolerance = 0.2f / 256;

} // namespace

TEST(TextureArray, EmptyHasNoDescriptors) {
  const TextureArray textures(test::gpuDevice(), {});
  EXPECT_EQ(textures.size(), 0u);
  EXPECT_EQ(textures.layout(), VkDescriptorSetLayout(VK_NULL_HANDLE));
  EXPECT_EQ(textures.set(), VkDescriptorSet(VK_NULL_HANDLE));
}

TEST(TextureArray, EachLaneReadsItsOwnTexture) {
  std::vector<ImageData> images;
  for (uint32_t i = 0; i < 20; ++i) images.push_back(image(1, 1, 8, {i, 2 * i, 3 * i, 255 - i}));
  std::vector<TextureUpload> uploads;
  for (const auto& made : images) uploads.push_back({.image = &made});
  const TextureArray textures(test::gpuDevice(), uploads);
  std::vector<TextureCase> cases;
  for (uint32_t i = 0; i < 200; ++i) cases.push_back({(7 * i) % 20, {0.5f, 0.5f}});
  const auto results = read(textures, cases);
  for (size_t i = 0; i < cases.size(); ++i) {
    const auto n = static_cast<float>(cases[i].texture);
    const glm::vec4 difference = results[i].color * 255.0f - glm::vec4(n, 2 * n, 3 * n, 255 - n);
    EXPECT_LT(glm::length(difference), 1e-3f) << i;
  }
}

TEST(TextureArray, FiltersAsAsked) {
  const ImageData data = ramp(4);
  const std::vector<TextureUpload> uploads{{.image = &data, .filter = Filter::Linear},
                                           {.image = &data, .filter = Filter::Nearest}};
  const TextureArray textures(test::gpuDevice(), uploads);
  // Texel centers lie at (x + 0.5) / 4.
  const auto results =
      read(textures, {{0, {0.5f, 0.5f}}, {0, {0.4375f, 0.5f}}, {1, {0.49f, 0.5f}}, {1, {0.51f, 0.5f}}});
  EXPECT_NEAR(results[0].color.x, 0.3f, kFilterTolerance);
  EXPECT_NEAR(results[1].color.x, 0.25f, kFilterTolerance);
  EXPECT_FLOAT_EQ(results[2].color.x, 0.2f);
  EXPECT_FLOAT_EQ(results[3].color.x, 0.4f);
}

TEST(TextureArray, FilteredValuesAreFinerThanTheTexels) {
  // One step of 8 bits apart: a device that rounds filtered values to 8 bits shows two values, not a ramp.
  const ImageData data = image(2, 1, 8, {100, 0, 0, 255, 101, 0, 0, 255});
  const std::vector<TextureUpload> uploads{{.image = &data, .wrapS = Wrap::ClampToEdge, .wrapT = Wrap::ClampToEdge}};
  const TextureArray textures(test::gpuDevice(), uploads);
  const auto results = read(textures, {{0, {0.375f, 0.5f}}, {0, {0.5f, 0.5f}}, {0, {0.625f, 0.5f}}});
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(results[static_cast<size_t>(i)].color.x * 255, 100.25 + 0.25 * i, 1.0 / 64) << i;
  }
}

TEST(TexturePixels, WideningKeepsEveryValue) {
  std::vector<uint32_t> values(256 * 4);
  for (uint32_t i = 0; i < values.size(); ++i) values[i] = i / 4;
  const ImageData data = image(16, 16, 8, values);
  const auto pixels = gpu::texturePixels(data, gpu::textureFormat(data, false, true).format, 0, 16);
  ASSERT_EQ(pixels.size(), 2 * data.pixels.size());
  for (size_t i = 0; i < values.size(); ++i) {
    uint16_t wide = 0;
    std::memcpy(&wide, &pixels[2 * i], sizeof(wide));
    EXPECT_EQ(wide * 255u, values[i] * 65535u);
  }
}

TEST(TextureArray, WrapsEachAxisAsAsked) {
  // 2 x 2: red tells the column, green the row.
  const ImageData data = image(2, 2, 8, {0, 0, 0, 255, 255, 0, 0, 255, 0, 255, 0, 255, 255, 255, 0, 255});
  const std::vector<TextureUpload> uploads{
      {.image = &data, .wrapS = Wrap::Repeat, .wrapT = Wrap::ClampToEdge, .filter = Filter::Nearest},
      {.image = &data, .wrapS = Wrap::ClampToEdge, .wrapT = Wrap::MirroredRepeat, .filter = Filter::Nearest},
      {.image = &data, .wrapS = Wrap::MirroredRepeat, .wrapT = Wrap::Repeat, .filter = Filter::Nearest}};
  const TextureArray textures(test::gpuDevice(), uploads);
  const auto results =
      read(textures, {{0, {1.25f, 1.25f}}, {1, {1.25f, 1.25f}}, {2, {1.25f, 1.25f}}, {0, {-0.25f, -3.0f}}});
  EXPECT_EQ(glm::vec2(results[0].color), glm::vec2(0, 1));
  EXPECT_EQ(glm::vec2(results[1].color), glm::vec2(1, 1));
  EXPECT_EQ(glm::vec2(results[2].color), glm::vec2(1, 0));
  EXPECT_EQ(glm::vec2(results[3].color), glm::vec2(1, 0));
}

TEST(TextureArray, SrgbIsDecodedAtEitherDepthAndAlphaIsNot) {
  std::vector<uint32_t> eight;
  std::vector<uint32_t> sixteen;
  for (uint32_t x = 0; x < 256; ++x) {
    eight.insert(eight.end(), {x, x, x, x});
    sixteen.insert(sixteen.end(), {257 * x, 257 * x, 257 * x, 257 * x});
  }
  const ImageData images[] = {image(256, 1, 8, eight), image(256, 1, 16, sixteen)};
  const std::vector<TextureUpload> uploads{{.image = &images[0], .filter = Filter::Nearest, .srgb = true},
                                           {.image = &images[1], .filter = Filter::Nearest, .srgb = true}};
  const TextureArray textures(test::gpuDevice(), uploads);
  std::vector<TextureCase> cases;
  for (uint32_t texture = 0; texture < 2; ++texture) {
    for (uint32_t x = 0; x < 256; ++x) cases.push_back({texture, {(static_cast<float>(x) + 0.5f) / 256.0f, 0.5f}});
  }
  const auto results = read(textures, cases);
  for (size_t i = 0; i < cases.size(); ++i) {
    const double encoded = static_cast<double>(i % 256) / 255.0;
    // Vulkan 1.3, 16.1 "Texel decoding" via Khronos Data Format 13.3.1 leaves 8-bit decoders half a code of freedom.
    const double tolerance = i < 256 ? 0.5 / 255 : 1e-6;
    EXPECT_NEAR(results[i].color.x, gpu::linearFromSrgb(encoded), tolerance) << i;
    EXPECT_NEAR(results[i].color.w, encoded, 1e-6) << i;
  }
}

TEST(TextureArray, SixteenBitLinearImagesKeepTheirBits) {
  const ImageData data = image(2, 1, 16, {1, 2, 3, 65535, 32768, 65534, 0, 40000});
  const TextureArray textures(test::gpuDevice(),
                              std::vector<TextureUpload>{{.image = &data, .filter = Filter::Nearest}});
  const auto results = read(textures, {{0, {0.25f, 0.5f}}, {0, {0.75f, 0.5f}}});
  const glm::vec4 expected[] = {glm::vec4(1, 2, 3, 65535) / 65535.0f, glm::vec4(32768, 65534, 0, 40000) / 65535.0f};
  for (int i = 0; i < 2; ++i) {
    for (int c = 0; c < 4; ++c) EXPECT_NEAR(results[i].color[c], expected[i][c], 1e-7) << i << ", " << c;
  }
}

TEST(TextureArray, LargeImagesArriveWholeThroughSeveralStagingBands) {
  // 1024 x 6000 x 4 bytes = 23.4 MiB, beyond one staging buffer.
  constexpr uint32_t kWidth = 1024;
  constexpr uint32_t kHeight = 6000;
  ImageData data{.name = "large", .width = kWidth, .height = kHeight, .bitsPerChannel = 8};
  data.pixels.resize(size_t{kWidth} * kHeight * 4);
  for (uint32_t y = 0; y < kHeight; ++y) {
    for (uint32_t x = 0; x < kWidth; ++x) {
      const uint8_t texel[] = {uint8_t(x), uint8_t(y), uint8_t(y >> 8), uint8_t(x >> 8)};
      std::memcpy(&data.pixels[(size_t{y} * kWidth + x) * 4], texel, 4);
    }
  }
  const TextureArray textures(test::gpuDevice(),
                              std::vector<TextureUpload>{{.image = &data, .filter = Filter::Nearest}});
  std::vector<TextureCase> cases;
  for (uint32_t y = 0; y < kHeight; y += 7) {
    const uint32_t x = (y * 37) % kWidth;
    cases.push_back({0, {(static_cast<float>(x) + 0.5f) / kWidth, (static_cast<float>(y) + 0.5f) / kHeight}});
  }
  const auto results = read(textures, cases);
  for (size_t i = 0; i < cases.size(); ++i) {
    const auto y = static_cast<uint32_t>(7 * i);
    const uint32_t x = (y * 37) % kWidth;
    const auto expected = glm::vec4(x & 255, y & 255, y >> 8, x >> 8);
    EXPECT_LT(glm::length(results[i].color * 255.0f - expected), 0.01f) << "row " << y;
  }
}

TEST(TextureArray, EqualPixelsAreStoredOncePerColorSpace) {
  const ImageData first = ramp(5);
  const ImageData twin = ramp(5);
  const ImageData other = ramp(4);
  const auto bytes = [](const std::vector<TextureUpload>& uploads) {
    return TextureArray(test::gpuDevice(), uploads).bytes();
  };
  const uint64_t one = bytes({{.image = &first}});
  EXPECT_EQ(bytes({{.image = &first}, {.image = &first, .wrapS = Wrap::ClampToEdge}, {.image = &twin}}), one);
  EXPECT_GT(bytes({{.image = &first}, {.image = &first, .srgb = true}}), one);
  EXPECT_GT(bytes({{.image = &first}, {.image = &other}}), one);
}

TEST(TextureArray, BadImagesAreRefusedAndNothingLeaks) {
  const Device& device = test::gpuDevice();
  const uint64_t before = device.allocatedBytes();
  const ImageData good = ramp(5);
  ImageData shortOne = ramp(5);
  shortOne.pixels.pop_back();
  ImageData oddDepth = ramp(5);
  oddDepth.bitsPerChannel = 12;
  const ImageData empty;
  ImageData wide{.name = "wide", .width = device.impl().limits.maxImageDimension2D + 1, .height = 1};
  wide.pixels.resize(size_t{wide.width} * 4);
  for (const ImageData* bad : std::initializer_list<const ImageData*>{&shortOne, &oddDepth, &empty, nullptr}) {
    const std::vector<TextureUpload> uploads{{.image = &good}, {.image = bad}};
    EXPECT_THROW(TextureArray(device, uploads), Error);
  }
  EXPECT_THROW(TextureArray(device, std::vector<TextureUpload>{{.image = &good}, {.image = &wide}}), LimitError);
  EXPECT_EQ(device.allocatedBytes(), before);
}

TEST(TextureArray, MoveLeavesAnEmptyArray) {
  const uint64_t before = test::gpuDevice().allocatedBytes();
  {
    const ImageData data = ramp(3);
    TextureArray first(test::gpuDevice(), std::vector<TextureUpload>{{.image = &data}});
    TextureArray second(std::move(first));
    EXPECT_EQ(first.size(), 0u);
    EXPECT_EQ(first.layout(), VkDescriptorSetLayout(VK_NULL_HANDLE));
    TextureArray third;
    third = std::move(second);
    EXPECT_EQ(read(third, {{0, {0.5f, 0.5f}}})[0].color.w, 1.0f);
  }
  EXPECT_EQ(test::gpuDevice().allocatedBytes(), before);
}
