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

double solidAngle(const Environment& map, double row0, double row1) {
  return 2 * kPi / map.width * (std::cos(kPi * row0 / map.height) - std::cos(kPi * row1 / map.height));
}

/// Of a cell: from one row's center to the next one's, at the poles half of that.
double cellSolidAngle(const Environment& map, uint32_t y) {
  return solidAngle(map, std::max(y - 0.5, 0.0), std::min(y + 0.5, double(map.height)));
}

TEST(EnvironmentDensity, ConstantMapIsSampledBySolidAngleAndHasPowerFourPi) {
  for (const auto& [width, height] : {std::pair{1u, 1u}, {1u, 2u}, {64u, 32u}, {7u, 5u}}) {
    Environment map = black(width, height);
    map.pixels.assign(map.pixels.size(), glm::vec3(2));
    const auto density = environmentDensity(map);
    EXPECT_NEAR(density.power, 8 * kPi, 1e-6);
    for (uint32_t y = 0; y <= height; ++y) {
      for (uint32_t x = 0; x < width; ++x) {
        const double expected = cellSolidAngle(map, y) / (4 * kPi);
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
  ASSERT_EQ(density.marginal.size(), 102u);
  ASSERT_EQ(density.conditional.size(), 101u * 301u);
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
  check(density.marginal.data(), 101);
  for (size_t y = 0; y < 101; ++y) check(&density.conditional[y * 301], 300);
}

TEST(EnvironmentDensity, IsPositiveExactlyInTheCellsAroundLight) {
  Environment map = black(16, 8);
  map.pixels[0] = glm::vec3(0, 0, 1e-30f);         // between columns 15 and 1, from the pole to row 1
  map.pixels[5 * 16 + 9] = glm::vec3(1e30f, 0, 0); // 60 decades brighter
  map.pixels[3 * 16 + 15] = glm::vec3(0, 1, 0);    // between columns 14 and 0
  const auto density = environmentDensity(map);
  for (uint32_t y = 0; y <= 8; ++y) {
    for (uint32_t x = 0; x < 16; ++x) {
      const bool atCorner = y <= 1 && (x == 15 || x == 0);
      const bool atOther = (y == 5 || y == 6) && (x == 8 || x == 9);
      const bool atSeam = (y == 3 || y == 4) && (x == 14 || x == 15);
      EXPECT_EQ(probability(map, density, x, y) > 0, atCorner || atOther || atSeam) << x << " " << y;
    }
  }
}

TEST(EnvironmentDensity, CellsHaveTheMeanOfTheirCorners) {
  Environment map = black(4, 3);
  const float values[3][4] = {{1, 2, 3, 4}, {5, 6, 7, 8}, {9, 10, 11, 12}};
  for (size_t i = 0; i < 12; ++i) map.pixels[i] = glm::vec3(values[i / 4][i % 4]);
  const auto density = environmentDensity(map);
  double total = 0, expected[4][4];
  for (int y = 0; y <= 3; ++y) {
    for (int x = 0; x < 4; ++x) {
      const float* above = values[std::max(y - 1, 0)];
      const float* below = values[std::min(y, 2)];
      const double mean = double(above[x] + above[(x + 1) % 4] + below[x] + below[(x + 1) % 4]) / 4;
      total += expected[y][x] = mean * cellSolidAngle(map, static_cast<uint32_t>(y));
    }
  }
  for (uint32_t y = 0; y <= 3; ++y) {
    for (uint32_t x = 0; x < 4; ++x) EXPECT_NEAR(probability(map, density, x, y), expected[y][x] / total, 1e-6);
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
  EXPECT_NEAR(power, solidAngle(map, 0, 1), 1e-7);
}

} // namespace
} // namespace isophote
