// The denoised layer on images whose truth is known.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>

#include "denoise/atrous_filter.hpp"
#include "isophote/denoise.hpp"
#include "isophote/error.hpp"

namespace isophote {
namespace {

constexpr std::array<const char*, 3> kColors = {"R", "G", "B"};

/// What one pixel shows.
struct Surface {
  double light = 1; ///< radiance over albedo
  double albedo = 0.5;
  glm::vec3 normal{0, 0, 1};
  float height = 0; ///< along the normal, in pixels
  float coverage = 1;
  float samples = 16;
  [[nodiscard]] double radiance() const { return light * (coverage > 0 ? albedo : 1); }
};

using Wall = std::function<Surface(uint32_t x, uint32_t y)>;

/// The layers that Film::resolve makes of a wall seen from its front, pixels one metre wide, noise not among them.
Image seen(uint32_t width, uint32_t height, const Wall& wall, double standardError) {
  Image image{.width = width, .height = height};
  for (const char* name :
       {"R", "G", "B", "A", "stderr.R", "stderr.G", "stderr.B", "sampleCount.Y", "albedo.R", "albedo.G", "albedo.B",
        "normal.X", "normal.Y", "normal.Z", "position.X", "position.Y", "position.Z"}) {
    image.channels.push_back({name, {}});
  }
  for (uint32_t y = 0; y < height; ++y) {
    for (uint32_t x = 0; x < width; ++x) {
      const Surface s = wall(x, y);
      const auto radiance = static_cast<float>(s.radiance()), error = static_cast<float>(standardError),
                 albedo = s.coverage > 0 ? static_cast<float>(s.albedo) : 0.0f;
      const glm::vec3 normal = s.coverage > 0 ? s.normal : glm::vec3(0);
      const glm::vec3 position = s.coverage > 0 ? glm::vec3(x, -float(y), s.height) : glm::vec3(0);
      const float values[] = {radiance, radiance,  radiance,   s.coverage, error,     error,
                              error,    s.samples, albedo,     albedo,     albedo,    normal.x,
                              normal.y, normal.z,  position.x, position.y, position.z};
      for (size_t c = 0; c < image.channels.size(); ++c) image.channels[c].values.push_back(values[c]);
    }
  }
  return image;
}

/// Normal noise of eight replicates, with the error bars that they tell, of `share` of each value.
void addNoise(Image& image, double share, uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  for (size_t c = 0; c < 3; ++c) {
    for (size_t i = 0; i < image.channels[c].values.size(); ++i) {
      float& value = image.channels[c].values[i];
      double sum = 0, squares = 0;
      for (int r = 0; r < 8; ++r) {
        const double x = normal(random);
        sum += x;
        squares += x * x;
      }
      const double scale = share * double(value);
      image.channels[4 + c].values[i] = static_cast<float>(scale * std::sqrt((squares - sum * sum / 8) / 7));
      value += static_cast<float>(scale * sum / std::sqrt(8.0));
    }
  }
}

const std::vector<float>& layer(const Image& image, const std::string& name) { return image.find(name)->values; }

/// The filter on a flat wall in one direction, by its definition: five times the spline, each twice as wide.
std::vector<double> flatKernel() {
  std::vector<double> kernel = {1};
  const double spline[] = {1 / 16.0, 4 / 16.0, 6 / 16.0, 4 / 16.0, 1 / 16.0};
  for (size_t step : {1, 2, 4, 8, 16}) {
    std::vector<double> next(kernel.size() + 4 * step);
    for (size_t i = 0; i < next.size(); ++i) {
      for (size_t tap = 0; tap < 5; ++tap) {
        if (i >= tap * step && i - tap * step < kernel.size()) next[i] += spline[tap] * kernel[i - tap * step];
      }
    }
    kernel = next;
  }
  return kernel;
}

TEST(Denoise, AConstantImageStays) {
  Image image = seen(
      70, 50, [](uint32_t, uint32_t) { return Surface{}; }, 0.1);
  const Image before = image;
  addDenoised(image);
  for (const char* color : kColors) {
    for (const float value : layer(image, std::string("denoised.") + color)) EXPECT_NEAR(value, 0.5, 5e-7); // rounding
  }
  for (const Channel& channel : before.channels) EXPECT_EQ(layer(image, channel.name), channel.values) << channel.name;
}

// Where noise explains every difference the filter is linear: its answer to one pixel says how far noise falls, here to
// 1.5%, and that no light is lost.
TEST(Denoise, OnAFlatWallNoiseFallsByTheKernel) {
  const std::vector<double> kernel = flatKernel();
  const auto side = static_cast<uint32_t>(kernel.size());
  constexpr float kImpulse = 1;
  denoise::FilterImage wall{.width = side, .height = side};
  wall.color.assign(size_t{side} * side, glm::vec3(0));
  wall.variance.assign(size_t{side} * side, glm::vec3(1e6f));
  wall.color[size_t{side / 2} * side + side / 2] = glm::vec3(kImpulse);
  std::vector<denoise::Guide> guides(size_t{side} * side, {.normal = {0, 0, 1}, .coverage = 1});
  for (size_t i = 0; i < guides.size(); ++i) guides[i].position = {i % side, i / side, 0};
  const denoise::FilterImage result = denoise::atrousFilter(wall, guides);
  double squares = 0, oneWay = 0;
  for (const double weight : kernel) oneWay += weight * weight;
  for (size_t i = 0; i < guides.size(); ++i) {
    const double response = double(result.color[i].g), expected = kernel[i % side] * kernel[i / side];
    if (i == guides.size() / 2) {
      EXPECT_NEAR(response, expected, 1e-4 * expected);
    }
    squares += response * response;
  }
  // At the rim of the image taps are missing and the others count for more: 2% of the squares.
  EXPECT_NEAR(squares / (oneWay * oneWay), 1, 0.03);
  // The variance that the filter goes by is the one that is left: without the correlation of taps it is a hundredth.
  EXPECT_NEAR(double(result.variance[guides.size() / 2].g) / (1e6 * oneWay * oneWay), 1, 0.02);
}

// With the error bars of eight replicates, noise of 20%.
TEST(Denoise, NoiseOfAKnownErrorFalls) {
  Image image = seen(
      96, 96, [](uint32_t, uint32_t) { return Surface{}; }, 0);
  addNoise(image, 0.2, 1);
  addDenoised(image);
  double noise = 0, left = 0, mean = 0;
  const auto &noisy = layer(image, "G"), &denoised = layer(image, "denoised.G");
  for (size_t i = 0; i < noisy.size(); ++i) {
    noise += std::pow(double(noisy[i]) - 0.5, 2);
    left += std::pow(double(denoised[i]) - 0.5, 2);
    mean += double(denoised[i]) / double(noisy.size());
  }
  EXPECT_LT(std::sqrt(left / noise), 0.2);
  EXPECT_NEAR(mean, 0.5, 0.005); // 0.1 of noise in 9216 pixels is 0.001
}

// Each edge is one that its own layer alone shows: under the error that is stated the color says nothing. No noise is
// in it, so that what changes is blur: less than 0.5% of the noise.
TEST(Denoise, EdgesOfTheFirstHitStaySharp) {
  constexpr double kError = 0.2;
  struct Edge {
    const char* name;
    Surface left, right;
  };
  const Edge edges[] = {
      {"texture", {.light = 1, .albedo = 0.55}, {.light = 1, .albedo = 0.45}},
      {"material", {.light = 3, .albedo = 0.2}, {.light = 0.5, .albedo = 0.8}},
      {"normal", {.light = 1.2}, {.light = 0.8, .normal = {0, 0, -1}}},
      {"depth", {.light = 1.2}, {.light = 0.8, .height = -40}},
      {"coverage", {.light = 1.2}, {.light = 0.4, .coverage = 0}},
      {"samples", {.light = 1.2}, {.light = 0.8, .samples = 0}},
  };
  for (const Edge& edge : edges) {
    Image image = seen(
        64, 48, [&](uint32_t x, uint32_t) { return x < 32 ? edge.left : edge.right; }, kError);
    addDenoised(image);
    for (size_t i = 0; i < 64 * 48; ++i)
      ASSERT_NEAR(layer(image, "denoised.G")[i], layer(image, "G")[i], 0.005 * kError) << edge.name << ", pixel " << i;
  }
}

// Shadows and patterns that no layer knows, of contrasts from half a standard error to a hundred. One pixel that stands
// out alone by four errors is no such pattern: noise of eight replicates makes one of 200 pixels do so.
TEST(Denoise, AConvergedImageChangesByLessThanItsErrorBars) {
  constexpr double kError = 1e-3;
  struct Pattern {
    const char* name;
    std::function<double(uint32_t, uint32_t)> shade;
    std::vector<double> contrasts;
    double errors; ///< that a pixel may move
  };
  const std::vector<double> all = {0.5, 1, 2, 4, 8, 12, 100};
  const Pattern patterns[] = {
      {"edge", [](uint32_t x, uint32_t) { return x < 30 ? 0.0 : 1.0; }, all, 1},
      {"checkers", [](uint32_t x, uint32_t y) { return (x + y) % 2 == 0 ? 0.0 : 1.0; }, all, 1},
      {"wave", [](uint32_t x, uint32_t) { return 0.5 + 0.5 * std::sin(0.15 * x); }, all, 1},
      {"dot", [](uint32_t x, uint32_t y) { return x == 30 && y == 20 ? 1.0 : 0.0; }, {0.5, 1, 2, 100}, 2},
  };
  for (const Pattern& pattern : patterns) {
    for (const double contrast : pattern.contrasts) {
      const Wall wall = [&](uint32_t x, uint32_t y) {
        return Surface{.light = 2 * (0.5 + contrast * kError * pattern.shade(x, y))};
      };
      Image image = seen(60, 40, wall, kError);
      addDenoised(image);
      for (size_t i = 0; i < layer(image, "R").size(); ++i) {
        ASSERT_LT(std::abs(double(layer(image, "denoised.R")[i] - layer(image, "R")[i])), pattern.errors * kError)
            << pattern.name << " of contrast " << contrast << ", pixel " << i;
      }
    }
  }
}

TEST(Denoise, AnOutlierIsRemovedAndNotSmeared) {
  Image image = seen(
      64, 64, [](uint32_t, uint32_t) { return Surface{}; }, 0.05);
  const size_t at = 32 * 64 + 32;
  for (size_t c = 0; c < 3; ++c) image.channels[c].values[at] = image.channels[4 + c].values[at] = 50;
  addDenoised(image);
  for (size_t i = 0; i < 64 * 64; ++i) EXPECT_NEAR(layer(image, "denoised.R")[i], 0.5, i == at ? 0.5 : 0.05) << i;
}

// Pixels without error, without a hit and without samples in turn: what is known exactly stays, and nothing is NaN.
TEST(Denoise, WhatHasNoErrorStays) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> light(0, 4);
  const Wall wall = [&](uint32_t x, uint32_t y) {
    return Surface{
        .light = x % 3 == 0 ? 0 : light(random), .albedo = y % 2 == 0 ? 0 : 0.7, .coverage = float(x / 16 % 2)};
  };
  Image image = seen(48, 32, wall, 0);
  for (size_t i = 0; i < 48 * 32; i += 7) image.channels[7].values[i] = 0;
  addDenoised(image);
  for (size_t i = 0; i < 48 * 32; ++i) {
    const float before = layer(image, "B")[i], after = layer(image, "denoised.B")[i];
    EXPECT_LE(std::abs(after - before), 1e-6f * before) << i; // false for NaN
  }
}

TEST(Denoise, IsTheSameOnAnyNumberOfThreads) {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<float> value(0, 1);
  denoise::FilterImage image{.width = 31, .height = 17};
  std::vector<denoise::Guide> guides(31 * 17, {.normal = {0, 0, 1}, .coverage = 1});
  for (size_t i = 0; i < guides.size(); ++i) {
    image.color.emplace_back(value(random));
    image.variance.emplace_back(value(random));
    guides[i].position = {i % 31, i / 31, 0};
  }
  EXPECT_EQ(denoise::atrousFilter(image, guides, 1).color, denoise::atrousFilter(image, guides, 5).color);
}

TEST(Denoise, SaysWhichLayerIsMissing) {
  Image image = seen(
      4, 4, [](uint32_t, uint32_t) { return Surface{}; }, 0.1);
  EXPECT_THROW((void)denoisedImage(image), UsageError);
  std::erase_if(image.channels, [](const Channel& channel) { return channel.name == "normal.Y"; });
  try {
    addDenoised(image);
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("normal.Y"), std::string::npos);
  }
}

TEST(Denoise, TheLayerIsAnImageOfItsOwn) {
  Image image = seen(
      4, 4, [](uint32_t, uint32_t) { return Surface{}; }, 0.1);
  addDenoised(image);
  const Image denoised = denoisedImage(image);
  EXPECT_EQ(layer(denoised, "G"), layer(image, "denoised.G"));
  EXPECT_EQ(denoised.find("stderr.R"), nullptr);
  addDenoised(image); // again: no second layer
  EXPECT_EQ(std::count_if(image.channels.begin(), image.channels.end(),
                          [](const Channel& channel) { return channel.name == "denoised.R"; }),
            1);
}

} // namespace
} // namespace isophote
