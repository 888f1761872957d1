#include "glsl/light_environment_case.h"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "glsl/light_scene.hpp"
#include "oracle/environment_map.hpp"
#include "support/probe.hpp"
#include "support/statistics.hpp"
#include "test_glsl_kernels.hpp"

namespace isophote {
namespace {

using gpu::LightEnvironmentCase;
using gpu::LightEnvironmentResult;

constexpr double kPi = std::numbers::pi;

std::vector<LightEnvironmentResult> run(const Environment& map, const std::vector<LightEnvironmentCase>& cases) {
  test::LightScene scene;
  scene.environment = map;
  return test::runProbe<LightEnvironmentCase, LightEnvironmentResult>(
      test_glsl_kernels::kernelSource("light_environment_probe"), cases, scene.address());
}

Environment emptyMap(uint32_t width, uint32_t height, double rotation = 0) {
  Environment map;
  map.width = width;
  map.height = height;
  map.rotation = rotation;
  map.pixels.assign(size_t{width} * height, glm::vec3(0));
  return map;
}

/// Smooth noise with a few texels 1e4 times brighter.
Environment noiseMap(uint32_t width, uint32_t height, double rotation) {
  std::mt19937 generator(8);
  std::uniform_real_distribution<float> value(0.1f, 1);
  Environment map = emptyMap(width, height, rotation);
  for (auto& pixel : map.pixels) pixel = glm::vec3(value(generator), value(generator), value(generator));
  for (int i = 0; i < 3; ++i) map.pixels[generator() % map.pixels.size()] *= 1e4f;
  map.intensity = 0.5f;
  return map;
}

float lattice(uint32_t k) { return std::ldexp(static_cast<float>(k), -24); }

/// Map coordinates in [0, 1]^2 of a world direction, in double.
glm::dvec2 coordinates(const Environment& map, const glm::dvec3& d) {
  const double c = std::cos(map.rotation);
  const double s = std::sin(map.rotation);
  const glm::dvec3 m(c * d.x - s * d.z, d.y, s * d.x + c * d.z);
  return {0.5 + std::atan2(m.x, -m.z) / (2 * kPi), std::atan2(std::hypot(m.x, m.z), m.y) / kPi};
}

std::vector<LightEnvironmentCase> randomCases(uint32_t count) {
  std::mt19937 generator(9);
  std::normal_distribution<double> normal;
  std::vector<LightEnvironmentCase> cases(count);
  for (uint32_t i = 0; i < count; ++i) {
    glm::dvec3 d(normal(generator), normal(generator), normal(generator));
    if (i % 7 == 0) d.y *= std::exp(10 * normal(generator)); // close to the poles, or to the horizon
    if (i % 11 == 0) d.x *= 1e-6;                            // close to the seam
    cases[i] = {glm::vec3(glm::normalize(d)),
                {lattice(static_cast<uint32_t>(generator()) >> 8), lattice(static_cast<uint32_t>(generator()) >> 8)}};
  }
  return cases;
}

TEST(EnvironmentLight, LookupMatchesDouble) {
  for (const auto& map : {noiseMap(64, 32, 0), noiseMap(37, 19, 1.1), noiseMap(1, 5, 0), noiseMap(2, 1, -3)}) {
    const oracle::EnvironmentMap expected(map);
    float brightest = 0;
    for (const auto& pixel : map.pixels) brightest = std::max({brightest, pixel.r, pixel.g, pixel.b});
    const auto cases = randomCases(50'000);
    const auto results = run(map, cases);
    for (size_t i = 0; i < cases.size(); ++i) {
      const glm::dvec3 value = expected.radiance(glm::normalize(glm::dvec3(cases[i].direction)));
      // Coordinates are good to 4e-7, so the weights to that times the size; the brightest texel may be a neighbour.
      const double tolerance = 1e-6 * brightest * map.intensity * map.width;
      for (int c = 0; c < 3; ++c) {
        ASSERT_NEAR(results[i].radiance[c], value[c], tolerance + 1e-6 * value[c]) << map.width << " " << i;
      }
    }
  }
}

TEST(EnvironmentLight, OneTexelIsConstantToTheBit) {
  Environment map = emptyMap(1, 1);
  map.pixels[0] = {0.1f, 0.2f, 0.3f};
  for (const auto& result : run(map, randomCases(1000))) {
    ASSERT_EQ(result.radiance, map.pixels[0]);
    ASSERT_EQ(result.sampleRadiance, map.pixels[0]);
    ASSERT_NEAR(result.pdf * 4 * kPi, 1, 1e-6);
  }
}

/// The density that upload/environment_density.hpp describes, in double, from the map itself.
class CellDensity {
public:
  explicit CellDensity(const Environment& map) : map_(map) {
    for (int row = 0; row <= int(map.height); ++row) {
      for (int column = 0; column < int(map.width); ++column) total_ += mean(column, row) * solidAngle(row);
    }
  }

  /// cos(theta) at the upper edge of a row of cells; of the row after the last at the lower pole.
  [[nodiscard]] double edge(int row) const {
    return std::cos(kPi * std::clamp(row - 0.5, 0.0, double(map_.height)) / map_.height);
  }

  /// At uv in [0, 1]^2, per steradian.
  [[nodiscard]] double at(glm::dvec2 uv) const {
    const double left = uv.x * map_.width - 0.5;
    const int column = int(std::floor(left)), row = std::min(int(uv.y * map_.height + 0.5), int(map_.height));
    const double right = left - column;
    const double down = (edge(row) - std::cos(kPi * uv.y)) / (edge(row) - edge(row + 1));
    const double above = (1 - right) * luminance(column, row - 1) + right * luminance(column + 1, row - 1);
    const double below = (1 - right) * luminance(column, row) + right * luminance(column + 1, row);
    return ((1 - down) * above + down * below) / total_;
  }

  /// What single precision may be off by there: coordinates are good to 4e-7, in which the density may reach that of
  /// the brightest corner; probabilities have 24 bits.
  [[nodiscard]] double tolerance(glm::dvec2 uv) const {
    const int column = int(std::floor(uv.x * map_.width - 0.5));
    const int row = std::min(int(uv.y * map_.height + 0.5), int(map_.height));
    const double brightest = std::max({luminance(column, row - 1), luminance(column + 1, row - 1),
                                       luminance(column, row), luminance(column + 1, row)});
    return 1e-4 * at(uv) + 1e-6 * map_.width * brightest / total_;
  }

  /// Probability of quarter (right, lower) of a cell, halved in azimuth and in cos(theta).
  [[nodiscard]] double quarter(int column, int row, int right, int lower) const {
    const double x = right ? 0.75 : 0.25, y = lower ? 0.75 : 0.25; // the mean of a bilinear function
    const double above = (1 - x) * luminance(column, row - 1) + x * luminance(column + 1, row - 1);
    const double below = (1 - x) * luminance(column, row) + x * luminance(column + 1, row);
    return ((1 - y) * above + y * below) / total_ * solidAngle(row) / 4;
  }

private:
  [[nodiscard]] double luminance(int column, int row) const {
    const int x = (column + int(map_.width)) % int(map_.width), y = std::clamp(row, 0, int(map_.height) - 1);
    return glm::dot(glm::dvec3(map_.pixels[size_t(y) * map_.width + size_t(x)]), glm::dvec3(0.2126, 0.7152, 0.0722));
  }
  [[nodiscard]] double mean(int column, int row) const {
    return (luminance(column, row - 1) + luminance(column + 1, row - 1) + luminance(column, row) +
            luminance(column + 1, row)) /
           4;
  }
  [[nodiscard]] double solidAngle(int row) const { return 2 * kPi / map_.width * (edge(row) - edge(row + 1)); }

  const Environment& map_;
  double total_ = 0;
};

TEST(EnvironmentLight, DensityIsThatOfTheCells) {
  for (const Environment& map : {noiseMap(64, 32, 0.7), noiseMap(9, 7, 0), noiseMap(1, 1, 0), noiseMap(2, 1, 0.2)}) {
    const CellDensity expected(map);
    const auto cases = randomCases(50'000);
    const auto results = run(map, cases);
    for (size_t i = 0; i < cases.size(); ++i) {
      const double value = expected.at(coordinates(map, glm::dvec3(cases[i].direction)));
      // Coordinates are good to 4e-7, and the brightest texel may be a neighbor; probabilities have 24 bits.
      const double brightest = 1e4 / (map.width * map.height); // in units of the mean density, at most
      ASSERT_NEAR(results[i].pdf * 4 * kPi, value * 4 * kPi, 1e-4 * value * 4 * kPi + 1e-5 * brightest * map.width)
          << i;
    }
  }
}

// Bins: quarters of cells. 1e6 samples.
TEST(EnvironmentLight, SamplesFollowTheDensityByChiSquare) {
  const Environment maps[] = {noiseMap(16, 8, 0), noiseMap(9, 7, 2.2), noiseMap(1, 1, 0), noiseMap(1, 2, 0.3)};
  for (const Environment& map : maps) {
    const CellDensity density(map);
    const auto cases = randomCases(1'000'000);
    const int width = int(map.width), height = int(map.height);
    std::vector<uint64_t> counts(size_t(width) * size_t(height + 1) * 4);
    std::vector<double> expected(counts.size());
    const auto bin = [&](int column, int row, bool right, bool lower) {
      return size_t((2 * row + (lower ? 1 : 0)) * 2 * width + 2 * column + (right ? 1 : 0));
    };
    for (const auto& result : run(map, cases)) {
      const glm::dvec3 d(result.direction);
      const glm::dvec2 uv = coordinates(map, d);
      const int row = std::min(int(uv.y * height + 0.5), height);
      const double left = uv.x * width - 0.5;
      const int column = int(std::floor(left));
      const bool lower = density.edge(row) - d.y > 0.5 * (density.edge(row) - density.edge(row + 1));
      ++counts[bin((column + width) % width, row, left - column > 0.5, lower)];
    }
    for (int row = 0; row <= height; ++row) {
      for (int column = 0; column < width; ++column) {
        for (const auto& [right, lower] : {std::pair{0, 0}, {1, 0}, {0, 1}, {1, 1}}) {
          expected[bin(column, row, right != 0, lower != 0)] =
              density.quarter(column, row, right, lower) * double(cases.size());
        }
      }
    }
    EXPECT_GT(test::chiSquareTest(counts, expected).p, test::sidak(0.001, std::size(maps))) << map.width;
  }
}

TEST(EnvironmentLight, SampledRadianceAndDensityAreThoseOfTheSampledDirection) {
  for (const auto& map : {noiseMap(64, 32, 0.4), noiseMap(1024, 512, 0)}) {
    const CellDensity density(map);
    const auto results = run(map, randomCases(200'000));
    for (const auto& result : results) {
      ASSERT_NEAR(glm::length(glm::dvec3(result.direction)), 1, 1e-6);
      const double tolerance = density.tolerance(coordinates(map, glm::dvec3(result.direction)));
      ASSERT_NEAR(result.samplePdf, result.pdfAtSample, tolerance);
      const glm::vec3 difference = glm::abs(result.sampleRadiance - result.radianceAtSample);
      ASSERT_LT(std::max({difference.r, difference.g, difference.b}), 1e4 * 1e-6 * map.width);
    }
  }
}

/// Irradiance on a plane of normal n from the bilinear map, by the midpoint rule over the texels around one bright one.
double quadrature(const Environment& map, const glm::dvec3& n, int column, int row) {
  const oracle::EnvironmentMap oracle(map);
  const int parts = 240;
  double sum = 0;
  for (int y = std::max(row - 1, 0); y < std::min<int>(row + 2, static_cast<int>(map.height)); ++y) {
    const double top = std::cos(kPi * y / map.height);
    const double bottom = std::cos(kPi * (y + 1) / map.height);
    for (int j = 0; j < parts; ++j) {
      const double cosTheta = top + (bottom - top) * (j + 0.5) / parts;
      const double sinTheta = std::sqrt(1 - cosTheta * cosTheta);
      for (int x = column - 1; x <= column + 1; ++x) {
        for (int i = 0; i < parts; ++i) {
          const double phi = ((x + (i + 0.5) / parts) / map.width - 0.5) * 2 * kPi;
          const glm::dvec3 m(sinTheta * std::sin(phi), cosTheta, -sinTheta * std::cos(phi));
          const double c = std::cos(map.rotation);
          const double s = std::sin(map.rotation);
          const glm::dvec3 d(c * m.x + s * m.z, m.y, c * m.z - s * m.x);
          sum += oracle.radiance(d).r * std::max(glm::dot(n, d), 0.0) * (top - bottom);
        }
      }
    }
  }
  return sum * 2 * kPi / map.width / parts / parts;
}

// One bright texel at each pole, at the seam and amid the map: the estimated irradiance against quadrature. 24 jittered
// sets of 128 x 128; the t-test's own half width has to stay below 0.3%.
TEST(EnvironmentLight, OneBrightTexelLightsAPlaneAsQuadratureSays) {
  const uint32_t width = 16;
  const uint32_t height = 8;
  const std::pair<int, int> texels[] = {{5, 0}, {0, 7}, {15, 4}, {8, 3}, {3, 1}};
  std::mt19937 generator(35);
  std::uniform_real_distribution<double> jitter;
  for (const auto& [column, row] : texels) {
    Environment map = emptyMap(width, height, 0.9);
    map.pixels[static_cast<size_t>(row) * width + static_cast<size_t>(column)] = glm::vec3(100);
    const glm::dvec3 n = glm::normalize(glm::dvec3(0.3, row < 4 ? 1 : -1, 0.2));
    const int side = 128;
    std::vector<LightEnvironmentCase> cases;
    for (int replicate = 0; replicate < 24; ++replicate) {
      for (int i = 0; i < side * side; ++i) {
        const auto place = [&](int k) { return static_cast<uint32_t>((k + jitter(generator)) / side * 16777216); };
        cases.push_back({{0, 1, 0}, {lattice(place(i % side)), lattice(place(i / side))}});
      }
    }
    const auto results = run(map, cases);
    test::Moments means;
    for (int replicate = 0; replicate < 24; ++replicate) {
      double sum = 0;
      for (int i = 0; i < side * side; ++i) {
        const auto& result = results[static_cast<size_t>(replicate * side * side + i)];
        sum += result.sampleRadiance.r * std::max(glm::dot(n, glm::dvec3(result.direction)), 0.0) / result.samplePdf;
      }
      means.add(sum / (side * side));
    }
    const double expected = quadrature(map, n, column, row);
    const double level = test::sidak(0.001, std::size(texels));
    EXPECT_GT(test::meanTest(means, expected), level) << column << " " << row << " " << means.mean() << " " << expected;
    EXPECT_LE(test::studentTwoSidedQuantile(level, 23) * means.standardError(), 0.003 * expected);
  }
}

// Continuous and monotonic: well distributed numbers stay well distributed over the map.
TEST(EnvironmentLight, SamplesDescendFromPoleToPoleAsTheirNumberGrows) {
  for (const auto& map : {noiseMap(16, 8, 0), noiseMap(4, 5, 0), noiseMap(1, 1, 0)}) {
    std::vector<LightEnvironmentCase> cases;
    for (uint32_t k = 0; k < 4096; ++k) cases.push_back({{0, 1, 0}, {0.3f, lattice(k << 12)}});
    const auto results = run(map, cases);
    for (size_t i = 1; i < results.size(); ++i) {
      ASSERT_LE(results[i].direction.y, results[i - 1].direction.y + 1e-6f) << map.height << " " << i;
    }
  }
}

TEST(EnvironmentLight, ExtremeNumbersGiveUnitDirectionsWithPositiveDensity) {
  const uint32_t last = (1u << 24) - 1;
  const uint32_t values[] = {0, 1, last / 2, last / 2 + 1, last - 1, last};
  std::vector<LightEnvironmentCase> cases;
  const glm::vec3 axes[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}, {-0.0f, 1, -0.0f}};
  for (const auto& axis : axes) {
    for (const uint32_t x : values) {
      for (const uint32_t y : values) cases.push_back({axis, {lattice(x), lattice(y)}});
    }
  }
  for (const auto& map :
       {noiseMap(1, 1, 0), noiseMap(2, 1, 0), noiseMap(1, 2, 0), noiseMap(5, 3, 1), noiseMap(2048, 1024, 0)}) {
    for (const auto& result : run(map, cases)) {
      ASSERT_NEAR(glm::length(glm::dvec3(result.direction)), 1, 1e-6);
      ASSERT_TRUE(std::isfinite(result.samplePdf) && result.samplePdf > 0);
      ASSERT_TRUE(std::isfinite(result.pdf) && result.pdf > 0);
      ASSERT_TRUE(result.radiance.r > 0 && std::isfinite(result.radiance.r));
    }
  }
}

} // namespace
} // namespace isophote
