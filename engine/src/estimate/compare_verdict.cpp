#include "estimate/compare_verdict.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "estimate/compare_student.hpp"
#include "shared/film_types.h"

namespace isophote::estimate {
namespace {

constexpr double kFamilySignificance = 0.001;
constexpr double kPassingFraction = 0.999;
constexpr double kRounding = 1e-5;
constexpr uint32_t kBlock = 4;

/// Sums over the pixels of a cell; a cell of one pixel is a pixel.
struct Cell {
  double difference = 0;
  double rounding = 0;       ///< difference that rounding may explain
  double variance = 0;       ///< of the difference
  double varianceSpread = 0; ///< sum of variance_i^2 / dof_i: Satterthwaite's denominator

  void add(const Cell& other) {
    difference += other.difference;
    rounding += other.rounding;
    variance += other.variance;
    varianceSpread += other.varianceSpread;
  }

  [[nodiscard]] double p() const {
    const double excess = std::max(0.0, std::abs(difference) - rounding);
    if (excess == 0) return 1;
    if (variance <= 0) return 0;
    const double dof =
        varianceSpread > 0 ? variance * variance / varianceSpread : std::numeric_limits<double>::infinity();
    return studentTwoSided(excess / std::sqrt(variance), dof);
  }
};

struct Grid {
  uint32_t width = 0;
  uint32_t height = 0;
  std::vector<Cell> cells;
  std::vector<uint32_t> counts; ///< conclusive pixels in each cell

  Grid(uint32_t w, uint32_t h) : width(w), height(h), cells(size_t(w) * h), counts(size_t(w) * h) {}
  void add(uint32_t x, uint32_t y, const Cell& cell, uint32_t count) {
    const size_t index = size_t(y / kBlock) * width + x / kBlock;
    cells[index].add(cell);
    counts[index] += count;
  }
};

Grid coarserGrid(uint32_t width, uint32_t height) {
  return {(width + kBlock - 1) / kBlock, (height + kBlock - 1) / kBlock};
}

/// The planes of one color channel of one image.
struct Estimate {
  const std::vector<float>& mean;
  const std::vector<float>& standardError;
  const std::vector<float>* sampleCount; ///< null: assume that all replicates hold samples

  /// 0 where the standard error is not known.
  [[nodiscard]] double degreesOfFreedom(size_t pixel) const {
    if (!std::isfinite(mean[pixel]) || !std::isfinite(standardError[pixel])) return 0;
    const double count = sampleCount != nullptr ? double((*sampleCount)[pixel]) : double(gpu::kReplicateCount);
    return std::min(count, double(gpu::kReplicateCount)) - 1;
  }
};

std::optional<Estimate> findEstimate(const Image& image, const std::string& color) {
  const Channel* mean = image.find(color);
  const Channel* error = image.find("stderr." + color);
  if (mean == nullptr || error == nullptr) return std::nullopt;
  const Channel* count = image.find("sampleCount.Y");
  return Estimate{mean->values, error->values, count != nullptr ? &count->values : nullptr};
}

std::optional<Cell> testPixel(const Estimate& a, const Estimate& b, size_t pixel) {
  const double dofA = a.degreesOfFreedom(pixel);
  const double dofB = b.degreesOfFreedom(pixel);
  if (!(dofA > 0 && dofB > 0)) return std::nullopt;
  const double variance = std::pow(double(a.standardError[pixel]), 2) + std::pow(double(b.standardError[pixel]), 2);
  const double meanA = a.mean[pixel];
  const double meanB = b.mean[pixel];
  return Cell{.difference = meanA - meanB,
              .rounding = kRounding * std::max(std::abs(meanA), std::abs(meanB)),
              .variance = variance,
              .varianceSpread = variance * variance / std::min(dofA, dofB)};
}

/// p-values of one level, kept as what the verdict needs once the number of tests is known.
struct Tally {
  std::vector<double> smallPixels; ///< p-values below the family significance, the only ones that can fail
  std::vector<double> smallBlocks;
  uint64_t tests = 0;
  uint64_t inconclusive = 0;
  double smallest = 1;

  void add(double p, std::vector<double>& small) {
    ++tests;
    smallest = std::min(smallest, p);
    if (p < kFamilySignificance) small.push_back(p);
  }
};

void testBlocks(Grid grid, Tally& tally) {
  while (true) {
    for (size_t i = 0; i < grid.cells.size(); ++i) {
      if (grid.counts[i] > 0) tally.add(grid.cells[i].p(), tally.smallBlocks);
    }
    if (grid.cells.size() == 1) return;
    Grid next = coarserGrid(grid.width, grid.height);
    for (uint32_t y = 0; y < grid.height; ++y) {
      for (uint32_t x = 0; x < grid.width; ++x) {
        const size_t index = size_t(y) * grid.width + x;
        next.add(x, y, grid.cells[index], grid.counts[index]);
      }
    }
    grid = std::move(next);
  }
}

/// @param deviations  of the channel, one each three values
void testChannel(const Estimate& a, const Estimate& b, uint32_t width, uint32_t height, Tally& tally,
                 float* deviations) {
  Grid blocks = coarserGrid(width, height);
  for (uint32_t y = 0; y < height; ++y) {
    for (uint32_t x = 0; x < width; ++x) {
      const std::optional<Cell> cell = testPixel(a, b, size_t(y) * width + x);
      if (!cell) {
        ++tally.inconclusive;
        continue;
      }
      const double p = cell->p();
      deviations[3 * (size_t(y) * width + x)] = static_cast<float>(std::copysign(normalDeviation(p), cell->difference));
      tally.add(p, tally.smallPixels);
      blocks.add(x, y, *cell, 1);
    }
  }
  testBlocks(std::move(blocks), tally);
}

} // namespace

std::optional<Verdict> compareStatistically(const Image& a, const Image& b) {
  Tally tally;
  Verdict verdict;
  verdict.deviations.assign(size_t{3} * a.width * a.height, 0);
  constexpr std::array<const char*, 3> kColors = {"R", "G", "B"};
  for (size_t c = 0; c < kColors.size(); ++c) {
    const char* color = kColors[c];
    const auto estimateA = findEstimate(a, color);
    const auto estimateB = findEstimate(b, color);
    if (!estimateA || !estimateB) return std::nullopt;
    testChannel(*estimateA, *estimateB, a.width, a.height, tally, verdict.deviations.data() + c);
  }
  const double tests = std::max(1.0, static_cast<double>(tally.tests));
  const double significance = -std::expm1(std::log1p(-kFamilySignificance) / tests);
  const auto failing = [&](const std::vector<double>& small) {
    return static_cast<uint64_t>(std::count_if(small.begin(), small.end(), [&](double p) { return p < significance; }));
  };
  const double pixels = static_cast<double>(kColors.size()) * a.width * a.height;
  verdict.criticalDeviation = normalDeviation(significance);
  verdict.p = tally.smallest >= 1 ? 1 : -std::expm1(tests * std::log1p(-tally.smallest));
  verdict.passingFraction = 1 - static_cast<double>(failing(tally.smallPixels) + tally.inconclusive) / pixels;
  verdict.failingBlocks = failing(tally.smallBlocks);
  verdict.same = verdict.passingFraction >= kPassingFraction && verdict.failingBlocks == 0;
  return verdict;
}

} // namespace isophote::estimate
