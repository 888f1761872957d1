// Preetham's sky against numbers worked out apart from it, and against published formulas of daylight.
#include "isophote/sky.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "isophote/error.hpp"

namespace isophote {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kDegree = kPi / 180;

double luminanceOf(glm::dvec3 rgb) { return glm::dot(rgb, glm::dvec3(0.2126729, 0.7151522, 0.0721750)); }

/// Illuminance of the map on the ground, lux.
double skyIlluminance(const Environment& map) {
  double sum = 0;
  for (uint32_t row = 0; row < map.height; ++row) {
    const double theta = kPi * (row + 0.5) / map.height;
    const double weight = std::max(std::cos(theta), 0.0) * std::sin(theta) * kPi / map.height * 2 * kPi / map.width;
    for (uint32_t column = 0; column < map.width; ++column)
      sum += weight * luminanceOf(glm::dvec3(map.pixels[size_t{row} * map.width + column]));
  }
  return sum;
}

// Zenith and sky by a separate program that multiplies the paper's matrices out, in units of kcd/m^2.
TEST(Sky, ZenithAndDistributionMatchThePapersFormulas) {
  struct Case {
    double thetaSun, turbidity, theta, gamma;
    glm::dvec3 zenith, sky;
  };
  const Case cases[] = {
      {30, 2, 60, 45, {5.88674325, 0.251421462, 0.255923838}, {9.42303337, 0.253579096, 0.260793679}},
      {60, 3, 45, 90, {5.13915604, 0.244928594, 0.252573124}, {4.68373927, 0.242801113, 0.255312117}},
      {85, 6, 80, 10, {2.45703859, 0.285566213, 0.30751712}, {9.38331207, 0.424581817, 0.417719394}},
      {10, 2.5, 20, 15, {14.4671921, 0.26555793, 0.274624906}, {13.147017, 0.262832502, 0.270937862}},
      {50, 10, 85, 130, {19.8423396, 0.28777618, 0.310400084}, {8.93070775, 0.357978884, 0.365163708}},
  };
  for (const Case& c : cases) {
    const glm::dvec3 zenith = skyZenith(c.thetaSun * kDegree, c.turbidity);
    const glm::dvec3 sky = skyRadiance(c.theta * kDegree, c.gamma * kDegree, c.thetaSun * kDegree, c.turbidity);
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(zenith[i] / c.zenith[i], 1, 1e-8);
      EXPECT_NEAR(sky[i] / c.sky[i], 1, 1e-8);
    }
  }
}

// The zenith is where the distribution is anchored.
TEST(Sky, DistributionIsOneAtTheZenith) {
  for (const double thetaSun : {0.1, 0.8, 1.5}) {
    const glm::dvec3 zenith = skyZenith(thetaSun, 4);
    EXPECT_LT(glm::length(skyRadiance(0, thetaSun, thetaSun, 4) - zenith), 1e-12);
  }
}

// Direct sun of a clear day: 127.5 klx exp(-0.21 air mass); clear sky on the ground: 0.8 + 15.5 sqrt(sin elevation)
// klx. DiLaura 1984, "Recommended Practice for the Calculation of Daylight Availability" (IES), which has no turbidity:
// a factor of 1.3 for the sun and 2 for the sky is what clear days differ by.
TEST(Sky, IlluminancesAreThoseOfClearDays) {
  for (const double elevation : {20.0, 45.0, 70.0}) {
    const Sky sky = makeSky({.elevationDegrees = elevation, .azimuthDegrees = 30, .turbidity = 2.5});
    const double sine = std::sin(elevation * kDegree);
    const double sun = 127.5e3 * std::exp(-0.21 / sine);
    EXPECT_LT(std::abs(std::log(luminanceOf(glm::dvec3(sky.sun.intensity)) / sun)), std::log(1.3)) << elevation;
    const double diffuse = 800 + 15500 * std::sqrt(sine);
    EXPECT_LT(std::abs(std::log(skyIlluminance(sky.environment) / diffuse)), std::log(2)) << elevation;
  }
}

TEST(Sky, SunStandsWhereTheSkyIsBrightest) {
  const Sky sky = makeSky({.elevationDegrees = 30, .azimuthDegrees = 90, .turbidity = 4});
  EXPECT_LT(glm::length(sky.sun.direction - glm::dvec3(-std::cos(30 * kDegree), -0.5, 0)), 1e-12); // from +x
  const Environment& map = sky.environment;
  size_t brightest = 0;
  for (size_t i = 0; i < map.pixels.size(); ++i) {
    for (int c = 0; c < 3; ++c) ASSERT_TRUE(map.pixels[i][c] >= 0 && std::isfinite(map.pixels[i][c]));
    if (map.pixels[i].g > map.pixels[brightest].g) brightest = i;
  }
  const double u = (static_cast<double>(brightest % map.width) + 0.5) / map.width;
  const double v = (static_cast<double>(brightest / map.width) + 0.5) / map.height;
  EXPECT_NEAR(u, 0.75, 1.0 / map.width);
  EXPECT_NEAR(v, 60.0 / 180, 6.0 / 180); // towards the horizon the air is brighter
  for (size_t i = map.pixels.size() / 2; i < map.pixels.size(); ++i) ASSERT_EQ(map.pixels[i], glm::vec3(0));
}

TEST(Sky, LowSunIsDimmerAndRedder) {
  const glm::dvec3 high = sunIlluminance(20 * kDegree, 3);
  const glm::dvec3 low = sunIlluminance(85 * kDegree, 3);
  EXPECT_LT(luminanceOf(low), 0.2 * luminanceOf(high));
  EXPECT_GT(low.r / low.b, 2 * high.r / high.b);
}

TEST(Sky, ValuesOutsideTheFitAreRefused) {
  EXPECT_THROW((void)makeSky({.elevationDegrees = -1}), Error);
  EXPECT_THROW((void)makeSky({.elevationDegrees = 91}), Error);
  EXPECT_THROW((void)makeSky({.turbidity = 1}), Error);
  EXPECT_THROW((void)makeSky({.turbidity = std::nan("")}), Error);
}

} // namespace
} // namespace isophote
