// LDR-FLIP against a slow reading of the paper: dense two-dimensional filters in double precision.
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "estimate/flip.hpp"

namespace isophote::estimate {
namespace {

constexpr double kPpd = kDefaultPixelsPerDegree;

struct Picture {
  int width, height;
  std::vector<glm::dvec3> pixels;
  [[nodiscard]] const glm::dvec3& at(int x, int y) const {
    return pixels[static_cast<size_t>(std::clamp(y, 0, height - 1) * width + std::clamp(x, 0, width - 1))];
  }
};

double decode(double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); }

glm::dvec3 xyzOverWhite(glm::dvec3 rgb) {
  const glm::dvec3 xyz = {(10135552 * rgb.r + 8788810 * rgb.g + 4435075 * rgb.b) / 24577794,
                          (2613072 * rgb.r + 8788810 * rgb.g + 887015 * rgb.b) / 12288897,
                          (1425312 * rgb.r + 8788810 * rgb.g + 70074185 * rgb.b) / 73733382};
  return xyz / glm::dvec3(0.950428545, 1, 1.088900371);
}

glm::dvec3 opponent(glm::dvec3 srgb) {
  const glm::dvec3 v = xyzOverWhite({decode(srgb.r), decode(srgb.g), decode(srgb.b)});
  return {116 * v.y - 16, 500 * (v.x - v.y), 200 * (v.y - v.z)};
}

// The inverse printed in the authors' own implementation, to nine digits.
glm::dvec3 linearRgb(glm::dvec3 o) {
  const double y = (o.x + 16) / 116;
  const glm::dvec3 v = glm::dvec3(y + o.y / 500, y, y - o.z / 200) * glm::dvec3(0.950428545, 1, 1.088900371);
  return {3.241003275 * v.x - 1.537398934 * v.y - 0.498615861 * v.z,
          -0.969224334 * v.x + 1.875930071 * v.y + 0.041554224 * v.z,
          0.055639423 * v.x - 0.204011202 * v.y + 1.057148933 * v.z};
}

glm::dvec3 lab(glm::dvec3 rgb) {
  const glm::dvec3 v = xyzOverWhite(glm::clamp(rgb, 0.0, 1.0));
  const auto f = [](double t) { return t > 216.0 / 24389 ? std::cbrt(t) : t * 841 / 108 + 4.0 / 29; };
  const double lightness = 116 * f(v.y) - 16;
  return {lightness, 0.01 * lightness * 500 * (f(v.x) - f(v.y)), 0.01 * lightness * 200 * (f(v.y) - f(v.z))};
}

double colorDistance(glm::dvec3 a, glm::dvec3 b) {
  const glm::dvec3 d = a - b;
  return std::pow(std::abs(d.x) + std::sqrt(d.y * d.y + d.z * d.z), 0.7);
}

double colorError(double distance) {
  const double largest = colorDistance(lab({0, 1, 0}), lab({0, 0, 1}));
  const double knee = 0.4 * largest;
  return distance < knee ? distance * 0.95 / knee : 0.95 + (distance - knee) / (largest - knee) * 0.05;
}

using Weight = std::function<double(int, int)>;

double correlate(const Picture& image, int channel, int x, int y, int radius, const Weight& weight) {
  double sum = 0;
  for (int j = -radius; j <= radius; ++j) {
    for (int i = -radius; i <= radius; ++i) sum += weight(i, j) * image.at(x + i, y + j)[channel];
  }
  return sum;
}

/// Positive weights to sum 1, negative ones to sum -1.
Weight balanced(int radius, const Weight& weight) {
  double positive = 0;
  double negative = 0;
  for (int j = -radius; j <= radius; ++j) {
    for (int i = -radius; i <= radius; ++i) (weight(i, j) > 0 ? positive : negative) += std::abs(weight(i, j));
  }
  return [=](int i, int j) { return weight(i, j) / (weight(i, j) > 0 ? positive : negative); };
}

Weight sensitivity(double a1, double b1, double a2, double b2, int radius) {
  return balanced(radius, [=](int i, int j) {
    const double z = std::numbers::pi * std::numbers::pi * (i * i + j * j) / (kPpd * kPpd);
    return a1 * std::sqrt(std::numbers::pi / b1) * std::exp(-z / b1) +
           a2 * std::sqrt(std::numbers::pi / b2) * std::exp(-z / b2);
  });
}

/// One pixel of the map.
double slowFlip(const Picture& a, const Picture& b, int x, int y) {
  const int radius =
      static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * std::numbers::pi * std::numbers::pi)) * kPpd));
  const Weight kernels[3] = {sensitivity(1, 0.0047, 0, 1e-5, radius), sensitivity(1, 0.0053, 0, 1e-5, radius),
                             sensitivity(34.1, 0.04, 13.5, 0.025, radius)};
  glm::dvec3 filteredA;
  glm::dvec3 filteredB;
  for (int c = 0; c < 3; ++c) {
    filteredA[c] = correlate(a, c, x, y, radius, kernels[c]);
    filteredB[c] = correlate(b, c, x, y, radius, kernels[c]);
  }
  const double color = colorError(colorDistance(lab(linearRgb(filteredA)), lab(linearRgb(filteredB))));

  const double s = 0.5 * 0.082 * kPpd;
  const int reach = static_cast<int>(std::ceil(3 * s));
  const auto bell = [=](int i, int j) { return std::exp(-(i * i + j * j) / (2 * s * s)); };
  const Weight edge = balanced(reach, [=](int i, int j) { return -i * bell(i, j); });
  const Weight point = balanced(reach, [=](int i, int j) { return (i * i / (s * s) - 1) * bell(i, j); });
  const auto strength = [&](const Picture& image, const Weight& weight) {
    const Weight turned = [&](int i, int j) { return weight(j, i); };
    // Weights sum to 0, so the offset of (Y + 16) / 116 drops out.
    return std::hypot(correlate(image, 0, x, y, reach, weight), correlate(image, 0, x, y, reach, turned)) / 116;
  };
  const double feature =
      std::max(std::abs(strength(a, edge) - strength(b, edge)), std::abs(strength(a, point) - strength(b, point)));
  return std::pow(color, 1 - std::sqrt(feature / std::sqrt(2.0)));
}

std::vector<glm::vec3> noise(size_t pixels, uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(0, 1);
  std::vector<glm::vec3> image(pixels);
  for (glm::vec3& p : image) p = {uniform(random), uniform(random), uniform(random)};
  return image;
}

Picture toPicture(const std::vector<glm::vec3>& encoded, int width, int height) {
  Picture picture{width, height, {}};
  for (const glm::vec3& p : encoded) picture.pixels.push_back(opponent(p));
  return picture;
}

TEST(Flip, EqualsThePaperWithDenseFilters) {
  constexpr int kWidth = 31;
  constexpr int kHeight = 23;
  const auto reference = noise(kWidth * kHeight, 1);
  auto test = reference;
  const auto other = noise(kWidth * kHeight, 2);
  for (int y = 8; y < kHeight; ++y) { // faint on the left, strong on the right, none above
    for (int x = 0; x < kWidth; ++x) {
      const size_t i = static_cast<size_t>(y * kWidth + x);
      test[i] = glm::mix(reference[i], other[i], static_cast<float>(x) / kWidth);
    }
  }
  const auto map = flipMap(test, reference, kWidth, kHeight);
  const Picture a = toPicture(test, kWidth, kHeight);
  const Picture b = toPicture(reference, kWidth, kHeight);
  double mean = 0;
  for (const auto& [x, y] : {std::pair{0, 0}, {30, 22}, {15, 11}, {30, 0}, {0, 22}, {7, 9}, {22, 15}, {29, 13}}) {
    const double expected = slowFlip(a, b, x, y);
    EXPECT_NEAR(map[static_cast<size_t>(y * kWidth + x)], expected, 2e-5) << x << ", " << y;
    mean += expected / 8;
  }
  EXPECT_GT(mean, 0.05); // the case is not trivial
}

TEST(Flip, BlackToWhiteIsTheRedistributedLightness) {
  const std::vector<glm::vec3> black(12, glm::vec3(0));
  const std::vector<glm::vec3> white(12, glm::vec3(1));
  for (const float value : flipMap(black, white, 4, 3)) EXPECT_NEAR(value, colorError(std::pow(100, 0.7)), 1e-5);
}

TEST(Flip, IsZeroForEqualImagesAndSymmetric) {
  const auto a = noise(20 * 10, 3);
  const auto b = noise(20 * 10, 4);
  for (const float value : flipMap(a, a, 20, 10)) EXPECT_EQ(value, 0);
  const auto ab = flipMap(a, b, 20, 10);
  const auto ba = flipMap(b, a, 20, 10);
  for (size_t i = 0; i < ab.size(); ++i) {
    EXPECT_NEAR(ab[i], ba[i], 1e-6);
    EXPECT_TRUE(ab[i] > 0 && ab[i] <= 1);
  }
}

TEST(Flip, TakesASinglePixelAndThinImages) {
  for (const auto& [width, height] : {std::pair{1u, 1u}, {50u, 1u}, {1u, 50u}}) {
    const auto map = flipMap(noise(width * height, 5), noise(width * height, 6), width, height);
    for (const float value : map) EXPECT_TRUE(value >= 0 && value <= 1);
  }
}

} // namespace
} // namespace isophote::estimate
