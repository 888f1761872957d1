#include "upload/environment_density.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>
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

/// Means of the four luminances around each cell of a row: of the texel rows on both sides of it, the same one at the
/// poles. The cell of a column lies between it and the next one, periodic.
std::vector<double> cellMeans(const Environment& environment, uint32_t cellRow) {
  const size_t width = environment.width;
  const uint32_t above = cellRow == 0 ? 0 : cellRow - 1, below = std::min(cellRow, environment.height - 1);
  std::vector<double> columns(width, 0.0);
  for (const uint32_t y : {above, below}) {
    const glm::vec3* pixels = &environment.pixels[y * width];
    for (size_t x = 0; x < width; ++x) columns[x] += luminanceOf(pixels[x]);
  }
  std::vector<double> means(width);
  for (size_t x = 0; x < width; ++x) means[x] = 0.25 * (columns[x] + columns[x + 1 == width ? 0 : x + 1]);
  return means;
}

/// Between two angles from a pole, of one column: 2 pi / width times the difference of their cosines, as a product.
double solidAngleBetween(const Environment& environment, double theta0, double theta1) {
  return 4 * std::numbers::pi / environment.width * std::sin(0.5 * (theta1 + theta0)) *
         std::sin(0.5 * (theta1 - theta0));
}

/// Of a cell between the centers of two texel rows; the first and the last row of cells reach from a center to a pole.
double cellSolidAngle(const Environment& environment, uint32_t cellRow) {
  const double height = environment.height;
  const double first = std::max(cellRow - 0.5, 0.0), last = std::min(cellRow + 0.5, height);
  return solidAngleBetween(environment, first * std::numbers::pi / height, last * std::numbers::pi / height);
}

double powerOf(const Environment& environment) {
  double power = 0;
  for (uint32_t row = 0; row < environment.height; ++row) {
    double sum = 0;
    for (size_t x = 0; x < environment.width; ++x)
      sum += luminanceOf(environment.pixels[row * size_t{environment.width} + x]);
    const double step = std::numbers::pi / environment.height;
    power += sum * solidAngleBetween(environment, row * step, (row + 1) * step);
  }
  return power;
}

} // namespace

EnvironmentDensity environmentDensity(const Environment& environment) {
  EnvironmentDensity density;
  density.power = powerOf(environment);
  if (!(density.power > 0)) return {};
  std::vector<double> rowWeights;
  const uint32_t cellRows = environment.height + 1;
  density.conditional.reserve(cellRows * (environment.width + size_t{1}));
  for (uint32_t row = 0; row < cellRows; ++row) {
    const std::vector<double> means = cellMeans(environment, row);
    rowWeights.push_back(std::accumulate(means.begin(), means.end(), 0.0) * cellSolidAngle(environment, row));
    appendCumulative(means, density.conditional);
  }
  appendCumulative(rowWeights, density.marginal);
  return density;
}

} // namespace isophote
