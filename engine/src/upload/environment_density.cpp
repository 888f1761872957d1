#include "upload/environment_density.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>

namespace isophote {

namespace {

constexpr double kSteps = 16777216; // 2^24, the resolution of the sampler's numbers

/// Appends the cumulative sums of `weights`, from 0 to 1, as multiples of 2^-24: sampling then finds each bin with
/// exactly the difference of its sums, which is what the pdf is computed from. Positive weights get one step at least,
/// zero weights none; all zero: all sums 0. At most 2^24 weights.
void appendCumulative(std::span<const double> weights, std::vector<float>& sums) {
  double total = 0;
  double positive = 0;
  for (const double weight : weights) {
    total += weight;
    positive += weight > 0 ? 1 : 0;
  }
  const double scale = total > 0 ? (kSteps - positive) / total : 0;
  double running = 0;
  double seen = 0;
  sums.push_back(0);
  for (const double weight : weights) {
    running += weight;
    seen += weight > 0 ? 1 : 0;
    sums.push_back(static_cast<float>((std::round(running * scale) + seen) / kSteps));
  }
}

double luminanceOf(const glm::vec3& color) {
  return 0.2126 * static_cast<double>(color.r) + 0.7152 * static_cast<double>(color.g) +
         0.0722 * static_cast<double>(color.b);
}

/// Largest luminance in the 3x3 neighbourhoods of one row, periodic in x and clamped in y.
std::vector<double> neighbourhoodMaxima(const Environment& environment, uint32_t row) {
  const size_t width = environment.width;
  const uint32_t rows[] = {row == 0 ? 0 : row - 1, row, std::min(row + 1, environment.height - 1)};
  std::vector<double> columns(width, 0.0);
  for (const uint32_t y : rows) {
    const glm::vec3* pixels = &environment.pixels[y * width];
    for (size_t x = 0; x < width; ++x) columns[x] = std::max(columns[x], luminanceOf(pixels[x]));
  }
  std::vector<double> maxima(width);
  for (size_t x = 0; x < width; ++x) {
    maxima[x] = std::max({columns[x == 0 ? width - 1 : x - 1], columns[x], columns[x + 1 == width ? 0 : x + 1]});
  }
  return maxima;
}

/// Solid angle of each texel of a row: 2 pi / width times the difference of the edges' cosines, as a product.
double texelSolidAngle(const Environment& environment, uint32_t row) {
  const double height = environment.height;
  return 4 * std::numbers::pi / environment.width * std::sin(0.5 * std::numbers::pi / height) *
         std::sin(std::numbers::pi * (row + 0.5) / height);
}

} // namespace

EnvironmentDensity environmentDensity(const Environment& environment) {
  EnvironmentDensity density;
  std::vector<double> rowWeights;
  density.conditional.reserve(static_cast<size_t>(environment.height) * (environment.width + size_t{1}));
  for (uint32_t row = 0; row < environment.height; ++row) {
    const double solidAngle = texelSolidAngle(environment, row);
    const std::vector<double> maxima = neighbourhoodMaxima(environment, row);
    double sum = 0;
    for (size_t x = 0; x < environment.width; ++x) {
      sum += maxima[x];
      density.power += luminanceOf(environment.pixels[row * size_t{environment.width} + x]) * solidAngle;
    }
    rowWeights.push_back(sum * solidAngle);
    appendCumulative(maxima, density.conditional);
  }
  if (!(density.power > 0)) return {};
  appendCumulative(rowWeights, density.marginal);
  return density;
}

} // namespace isophote
