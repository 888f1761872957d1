// The statistical half of render.hpp.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "support/render.hpp"

namespace isophote::test {

namespace {

constexpr double kFilmDegreesOfFreedom = 7; // 8 replicates

/// Welch and Satterthwaite: a difference of means, or with two sums of many a sum of means.
struct Combined {
  double mean = 0;
  double variance = 0;
  double degreesTerm = 0; ///< sum of variance_i^2 / degrees_i

  void add(const Estimate& estimate, double weight) {
    const double share = estimate.variance * weight * weight;
    mean += estimate.mean * weight;
    variance += share;
    degreesTerm += share * share / estimate.degreesOfFreedom;
  }
  [[nodiscard]] double degreesOfFreedom() const { return degreesTerm > 0 ? variance * variance / degreesTerm : 1; }
  [[nodiscard]] double halfWidth(double significance) const {
    return studentTwoSidedQuantile(significance, degreesOfFreedom()) * std::sqrt(variance);
  }
};

/// The difference of two equally sized sets of pixels in one channel.
struct Difference {
  Combined combined;
  double magnitude = 0; ///< larger of the two means

  /// The part of the difference that rounding and device limits do not explain, in standard errors; infinite without
  /// noise.
  [[nodiscard]] double excess(double tolerance) const {
    return std::max(std::abs(combined.mean) - tolerance - kRounding * magnitude, 0.0);
  }
  [[nodiscard]] double p(double tolerance) const {
    const double unexplained = excess(tolerance);
    if (unexplained == 0) return 1;
    if (combined.variance == 0) return 0;
    return studentTwoSided(unexplained / std::sqrt(combined.variance), combined.degreesOfFreedom());
  }
};

Difference regionDifference(const MeasuredImage& a, const MeasuredImage& b, uint32_t x0, uint32_t y0, uint32_t size,
                            size_t channel) {
  const uint32_t x1 = std::min(x0 + size, a.width), y1 = std::min(y0 + size, a.height);
  const double weight = 1.0 / (double(x1 - x0) * (y1 - y0));
  Difference result;
  double meanA = 0, meanB = 0;
  for (uint32_t y = y0; y < y1; ++y) {
    for (uint32_t x = x0; x < x1; ++x) {
      const size_t pixel = size_t{y} * a.width + x;
      const Estimate &first = a.pixels[pixel][channel], &second = b.pixels[pixel][channel];
      result.combined.add(first, weight);
      result.combined.add(second, -weight);
      meanA += first.mean * weight;
      meanB += second.mean * weight;
    }
  }
  result.magnitude = std::max(std::abs(meanA), std::abs(meanB));
  return result;
}

/// Outcome of the same test over all regions of one size.
struct Survey {
  uint64_t tests = 0;
  uint64_t failures = 0;
  double smallestP = 1;
  std::string worst;
};

Survey survey(const MeasuredImage& a, const MeasuredImage& b, uint32_t size, double tolerance) {
  Survey result;
  const uint64_t columns = (a.width + size - 1) / size, rows = (a.height + size - 1) / size;
  result.tests = 3 * columns * rows;
  const double critical = sidak(testSignificance(), result.tests);
  for (uint32_t y = 0; y < a.height; y += size) {
    for (uint32_t x = 0; x < a.width; x += size) {
      for (size_t channel = 0; channel < 3; ++channel) {
        const Difference difference = regionDifference(a, b, x, y, size, channel);
        const double p = difference.p(tolerance);
        if (p < critical) ++result.failures;
        if (p >= result.smallestP) continue;
        result.smallestP = p;
        result.worst = fmt::format(
            "{}x{} at {},{} channel {}: difference {:.4g} of {:.4g}, standard error {:.2g}, p {:.2g}", size, size, x, y,
            channel, difference.combined.mean, difference.magnitude, std::sqrt(difference.combined.variance), p);
      }
    }
  }
  return result;
}

} // namespace

double testSignificance() { return sidak(kFamilySignificance, kTestFamily); }

MeasuredImage measured(const oracle::ReferenceImage& image) {
  MeasuredImage result{image.width, image.height, {}};
  for (const oracle::ReferencePixel& pixel : image.pixels) {
    auto& channels = result.pixels.emplace_back();
    for (int c = 0; c < 3; ++c)
      channels[static_cast<size_t>(c)] = {pixel.mean[c], pixel.standardError[c] * pixel.standardError[c],
                                          image.samplesPerPixel - 1.0};
  }
  return result;
}

MeasuredImage measured(const Image& image) {
  MeasuredImage result{image.width, image.height, {}};
  result.pixels.resize(size_t{image.width} * image.height);
  const std::array<const char*, 3> names{"R", "G", "B"};
  for (size_t c = 0; c < 3; ++c) {
    const std::vector<float> means = plane(image, names[c]);
    const std::vector<float> errors = plane(image, std::string("stderr.") + names[c]);
    for (size_t i = 0; i < result.pixels.size(); ++i)
      result.pixels[i][c] = {means[i], double(errors[i]) * errors[i], kFilmDegreesOfFreedom};
  }
  return result;
}

testing::AssertionResult meanIs(const Moments& values, double expected, double powerFloor) {
  const double degrees = std::max(static_cast<double>(values.count()) - 1, 1.0);
  const double halfWidth = studentTwoSidedQuantile(testSignificance(), degrees) * values.standardError();
  const std::string numbers =
      fmt::format("measured {:.7g} +- {:.2g} (critical), expected {:.7g}", values.mean(), halfWidth, expected);
  if (halfWidth > powerFloor * std::abs(expected)) return testing::AssertionFailure() << "inconclusive: " << numbers;
  if (std::abs(values.mean() - expected) > halfWidth + kRounding * std::abs(expected))
    return testing::AssertionFailure() << numbers;
  return testing::AssertionSuccess() << numbers;
}

testing::AssertionResult pixelMeanIs(const Image& image, const std::string& channel, double expected,
                                     double powerFloor) {
  Moments values;
  for (const float value : plane(image, channel)) values.add(value);
  return meanIs(values, expected, powerFloor);
}

testing::AssertionResult sameImage(const MeasuredImage& a, const MeasuredImage& b, const AgreementRule& rule) {
  if (a.width != b.width || a.height != b.height) return testing::AssertionFailure() << "sizes differ";
  std::string complaints;
  const Survey pixels = survey(a, b, 1, rule.absoluteTolerance);
  if (static_cast<double>(pixels.failures) > 0.001 * static_cast<double>(pixels.tests))
    complaints +=
        fmt::format("{} of {} pixel-channels differ; worst {}\n", pixels.failures, pixels.tests, pixels.worst);
  const Survey blocks = survey(a, b, 4, rule.absoluteTolerance);
  if (blocks.failures > 0)
    complaints += fmt::format("{} of {} blocks differ; worst {}\n", blocks.failures, blocks.tests, blocks.worst);
  const uint32_t whole = std::max(a.width, a.height);
  const Survey image = survey(a, b, whole, rule.absoluteTolerance);
  if (image.failures > 0) complaints += fmt::format("the image's mean differs: {}\n", image.worst);
  for (size_t channel = 0; channel < 3; ++channel) {
    const Difference difference = regionDifference(a, b, 0, 0, whole, channel);
    const double halfWidth = difference.combined.halfWidth(testSignificance());
    if (halfWidth > rule.powerFloor * difference.magnitude)
      complaints += fmt::format("inconclusive in channel {}: the mean {:.4g} is known to {:.2g}\n", channel,
                                difference.magnitude, halfWidth);
  }
  if (complaints.empty()) return testing::AssertionSuccess();
  return testing::AssertionFailure() << complaints;
}

} // namespace isophote::test
