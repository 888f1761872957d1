#include "upload/environment_density.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace isophote {
namespace {

constexpr double kPi = std::numbers::pi;

Environment black(uint32_t width, uint32_t height) {
  Environment environment;
  environment.width = width;
  environment.height = height;
  environment.pixels.assign(size_t{width} * height, glm::vec3(0));
  return environment;
}

double probability(const Environment& map, const EnvironmentDensity& density, uint32_t x, uint32_t y) {
  const size_t first = y * (size_t{map.width} + 1) + x;
  return (static_cast<double>(density.marginal[y + 1]) - static_cast<double>(density.marginal[y])) *
         (static_cast<double>(density.conditional[first + 1]) - static_cast<double>(density.conditional[first]));
}

double rowSolidAngle(const Environment& map, uint32_t y) {
  return 2 * kPi / map.width * (std::cos(kPi * y / map.height) - std::cos(kPi * (y + 1) / map.height));
}

TEST(EnvironmentDensity, ConstantMapIsSampledBySolidAngleAndHasPowerFourPi) {
  for (const auto& [width, height] : {std::pair{1u, 1u}, {1u, 2u}, {64u, 32u}, {7u, 5u}}) {
    Environment map = black(width, height);
    map.pixels.assign(map.pixels.size(), glm::vec3(2));
    const auto density = environmentDensity(map);
    EXPECT_NEAR(density.power, 8 * kPi, 1e-6);
    for (uint32_t y = 0; y < height; ++y) {
      for (uint32_t x = 0; x < width; ++x) {
        const double expected = rowSolidAngle(map, y) / (4 * kPi);
        EXPECT_NEAR(probability(map, density, x, y), expected,
                    2e-6 * expected + 2e-7 * (expected * width + 1.0 / width));
      }
    }
  }
}

TEST(EnvironmentDensity, SumsAreIncreasingMultiplesOfTheSamplersStepFromZeroToOne) {
  std::mt19937 generator(35);
  std::exponential_distribution<float> value;
  Environment map = black(300, 100);
  for (auto& pixel : map.pixels) pixel = glm::vec3(std::pow(value(generator), 8.0f), 0, value(generator));
  const auto density = environmentDensity(map);
  ASSERT_EQ(density.marginal.size(), 101u);
  ASSERT_EQ(density.conditional.size(), 100u * 301u);
  const auto check = [](const float* sums, size_t count) {
    EXPECT_EQ(sums[0], 0);
    EXPECT_EQ(sums[count], 1);
    for (size_t i = 0; i <= count; ++i) {
      const double steps = std::ldexp(static_cast<double>(sums[i]), 24);
      EXPECT_EQ(steps, std::round(steps));
      if (i > 0) {
        EXPECT_GT(sums[i], sums[i - 1]);
      }
    }
  };
  check(density.marginal.data(), 100);
  for (size_t y = 0; y < 100; ++y) check(&density.conditional[y * 301], 300);
}

TEST(EnvironmentDensity, IsPositiveExactlyInTheNeighbourhoodOfLight) {
  Environment map = black(16, 8);
  map.pixels[0] = glm::vec3(0, 0, 1e-30f);         // corner: wraps to column 15, stays in row 0
  map.pixels[5 * 16 + 9] = glm::vec3(1e30f, 0, 0); // 60 decades brighter
  map.pixels[3 * 16 + 15] = glm::vec3(0, 1, 0);    // wraps to column 0
  const auto density = environmentDensity(map);
  for (uint32_t y = 0; y < 8; ++y) {
    for (uint32_t x = 0; x < 16; ++x) {
      const bool nearCorner = y <= 1 && (x <= 1 || x == 15);
      const bool nearOther = y >= 4 && y <= 6 && x >= 8 && x <= 10;
      const bool nearSeam = y >= 2 && y <= 4 && (x >= 14 || x == 0);
      EXPECT_EQ(probability(map, density, x, y) > 0, nearCorner || nearOther || nearSeam) << x << " " << y;
    }
  }
}

TEST(EnvironmentDensity, BlackMapIsEmpty) {
  const auto density = environmentDensity(black(8, 4));
  EXPECT_TRUE(density.marginal.empty());
  EXPECT_TRUE(density.conditional.empty());
  EXPECT_EQ(density.power, 0);
}

TEST(EnvironmentDensity, PowerLeavesIntensityOut) {
  Environment map = black(4, 2);
  map.pixels[3] = glm::vec3(1);
  const double power = environmentDensity(map).power;
  map.intensity = 5;
  EXPECT_EQ(environmentDensity(map).power, power);
  EXPECT_NEAR(power, rowSolidAngle(map, 0), 1e-7);
}

} // namespace
} // namespace isophote
