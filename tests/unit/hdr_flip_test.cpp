// HDR-FLIP against its definition: exposures worked out by hand, and LDR-FLIP of images tone mapped here.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "estimate/flip.hpp"
#include "estimate/hdr_flip.hpp"

namespace isophote::estimate {
namespace {

// Narkowicz's curve without the pre-exposure of 0.6, and sRGB, written anew.
float shown(double x) {
  const double v = 0.6 * x;
  const double y = std::clamp(v * (2.51 * v + 0.03) / (v * (2.43 * v + 0.59) + 0.14), 0.0, 1.0);
  return static_cast<float>(y <= 0.0031308 ? 12.92 * y : 1.055 * std::pow(y, 1 / 2.4) - 0.055);
}

std::vector<glm::vec3> shown(const std::vector<glm::vec3>& image, double stops) {
  std::vector<glm::vec3> result(image.size());
  for (size_t i = 0; i < image.size(); ++i) {
    for (int c = 0; c < 3; ++c) result[i][c] = shown(std::exp2(stops) * double(image[i][c]));
  }
  return result;
}

constexpr uint32_t kSide = 24;

/// A lamp of 64 in a room near 0.5.
std::vector<glm::vec3> room(uint32_t seed, float noise) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> jitter(1 - noise, 1 + noise);
  std::vector<glm::vec3> image(size_t{kSide} * kSide);
  for (size_t i = 0; i < image.size(); ++i) {
    image[i] = glm::vec3(0.5f, 0.45f, 0.4f) * jitter(random);
    if (i % kSide < 4 && i / kSide < 4) image[i] = glm::vec3(64) * jitter(random);
  }
  return image;
}

TEST(HdrFlip, ExposuresRunFromTheBrightestPixelToTheMedian) {
  std::vector<glm::vec3> image(100, glm::vec3(0.25f));
  image[7] = glm::vec3(32); // seven stops above
  image[8] = glm::vec3(0);
  const ExposureRange range = flipExposures(image);
  EXPECT_EQ(range.count, 7u);
  EXPECT_NEAR(range.last - range.first, 7, 1e-9);
  // At either end that luminance is shown at 0.85, linear.
  const double v = 0.6 * 32 * std::exp2(range.first);
  EXPECT_NEAR(v * (2.51 * v + 0.03) / (v * (2.43 * v + 0.59) + 0.14), 0.85, 1e-9);
}

TEST(HdrFlip, IsTheLargestLdrFlipOverTheExposures) {
  const auto reference = room(1, 0), test = room(2, 0.3f);
  const ExposureRange range = flipExposures(reference);
  const std::vector<float> map = hdrFlipMap(test, reference, kSide, kSide);
  std::vector<float> expected(map.size());
  for (uint32_t i = 0; i < range.count; ++i) {
    const auto at = flipMap(shown(test, range.at(i)), shown(reference, range.at(i)), kSide, kSide);
    for (size_t p = 0; p < at.size(); ++p) expected[p] = std::max(expected[p], at[p]);
  }
  for (size_t p = 0; p < map.size(); ++p) ASSERT_NEAR(map[p], expected[p], 1e-4);
}

TEST(HdrFlip, SeesALampThatAnSdrPictureShowsAsWhite) {
  const auto reference = room(1, 0);
  auto test = reference;
  for (auto& pixel : test) pixel = pixel.r > 10 ? 0.5f * pixel : pixel; // the lamp at half
  const auto map = hdrFlipMap(test, reference, kSide, kSide);
  EXPECT_GT(map[kSide + 1], 0.2);
  EXPECT_LT(map[size_t{kSide} * kSide - 1], 1e-3);
}

TEST(HdrFlip, SurvivesNansNegativesAndBlackness) {
  auto image = room(3, 0.1f);
  image[5] = glm::vec3(NAN, -1, INFINITY);
  for (const float value : hdrFlipMap(image, room(1, 0), kSide, kSide)) EXPECT_TRUE(value >= 0 && value <= 1);
  const std::vector<glm::vec3> black(size_t{kSide} * kSide);
  for (const float value : hdrFlipMap(black, black, kSide, kSide)) EXPECT_EQ(value, 0);
}

} // namespace
} // namespace isophote::estimate
