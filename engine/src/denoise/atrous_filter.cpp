#include "denoise/atrous_filter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <future>
#include <limits>
#include <thread>

namespace isophote::denoise {
namespace {

constexpr int kRadius = 2;
constexpr std::array<float, 5> kSpline = {1.0f / 16, 4.0f / 16, 6.0f / 16, 4.0f / 16, 1.0f / 16};
/// Sum of the squared weights of one level in both directions.
constexpr double kSquaredWeights = (70.0 / 256) * (70.0 / 256);

constexpr int kNormalSquarings = 7; // the cosine to the power of 128: Schied et al. 2017, section 4.4
constexpr float kAlbedoTolerance = 0.1f;
constexpr float kCoverageTolerance = 0.1f;
constexpr float kPlaneTolerance = 0.1f; // sine of the angle at which a neighbor lies off the tangent plane

/// Rounding of colors and positions, relative: differences as small are none.
constexpr float kRounding = 1e-6f;

/// Exponents beyond which a tap is left out.
constexpr float kNegligible = 16;

/// Sum of the squared weights of the first `levels` levels, one after the other, in one direction.
double squaredWeights(uint32_t levels) {
  std::vector<double> kernel = {1};
  for (uint32_t level = 0; level < levels; ++level) {
    const size_t step = size_t{1} << level;
    std::vector<double> wider(kernel.size() + 4 * step, 0);
    for (size_t tap = 0; tap < kSpline.size(); ++tap) {
      for (size_t i = 0; i < kernel.size(); ++i) wider[i + tap * step] += double(kSpline[tap]) * kernel[i];
    }
    kernel = std::move(wider);
  }
  double sum = 0;
  for (const double weight : kernel) sum += weight * weight;
  return sum;
}

/// The one correlation between all taps of a level with which the variance falls as it does on a flat wall.
float tapCorrelation(uint32_t level) {
  const double oneWay = squaredWeights(level + 1) / squaredWeights(level);
  return static_cast<float>((oneWay * oneWay - kSquaredWeights) / (1 - kSquaredWeights));
}

/// Half the squared difference of two pixels' first hits, in tolerances: the weight's exponent, without normals.
float guideDistance(const Guide& p, const Guide& q) {
  if (p.empty || q.empty) return std::numeric_limits<float>::infinity();
  const float coverage = (p.coverage - q.coverage) / kCoverageTolerance;
  if (p.coverage <= 0 || q.coverage <= 0) return 0.5f * coverage * coverage;
  const glm::vec3 albedo = (p.albedo - q.albedo) / kAlbedoTolerance;
  const glm::vec3 way = q.position - p.position;
  const float off = std::max(std::abs(glm::dot(p.normal, way)), std::abs(glm::dot(q.normal, way)));
  const float rounding = kRounding * (glm::length(p.position) + glm::length(q.position)) + 1e-30f;
  const float plane = off / (kPlaneTolerance * glm::length(way) + rounding);
  return 0.5f * (coverage * coverage + glm::dot(albedo, albedo) + plane * plane);
}

float normalWeight(const Guide& p, const Guide& q) {
  if (p.coverage <= 0 || q.coverage <= 0) return 1;
  float weight = std::max(glm::dot(p.normal, q.normal), 0.0f);
  for (int i = 0; i < kNormalSquarings; ++i) weight *= weight;
  return weight;
}

float guideWeight(const Guide& p, const Guide& q) { return normalWeight(p, q) * std::exp(-guideDistance(p, q)); }

/// Half the squared difference over twice the joint variance, of the channel where it is most.
float colorDistance(const glm::vec3& p, const glm::vec3& pVariance, const glm::vec3& q, const glm::vec3& qVariance) {
  float most = 0;
  for (int c = 0; c < 3; ++c) {
    const float difference = p[c] - q[c];
    const float rounding = kRounding * (std::abs(p[c]) + std::abs(q[c])) + 1e-18f;
    const float joint = pVariance[c] + std::min(pVariance[c], qVariance[c]) + rounding * rounding;
    most = std::max(most, difference * difference / (4 * joint));
  }
  return most;
}

/// Calls `row(y)` for each of them, in bands side by side.
template <class Row> void forRows(uint32_t height, uint32_t threads, const Row& row) {
  const uint32_t cores = threads != 0 ? threads : std::max(1u, std::thread::hardware_concurrency());
  std::vector<std::future<void>> bands;
  for (uint32_t band = 0; band < cores; ++band) {
    bands.push_back(std::async(std::launch::async, [&, band] {
      for (uint32_t y = band; y < height; y += cores) row(y);
    }));
  }
  for (std::future<void>& band : bands) band.get();
}

/// What taps around a pixel add up to.
class TapSum {
public:
  void add(float weight, const glm::vec3& color, const glm::vec3& variance) {
    weights_ += weight;
    color_ += weight * color;
    deviation_ += weight * glm::sqrt(variance);
    squares_ += weight * weight * variance;
  }
  [[nodiscard]] float weights() const { return weights_; }
  [[nodiscard]] glm::vec3 color() const { return color_ / weights_; }
  /// Of taps that correlate with each other alike.
  [[nodiscard]] glm::vec3 variance(float correlation) const {
    return (squares_ + correlation * (deviation_ * deviation_ - squares_)) / (weights_ * weights_);
  }

private:
  float weights_ = 0;
  glm::vec3 color_{0}, deviation_{0}, squares_{0};
};

/// Calls `visit(index, weight of the kernel)` for the taps within the image.
template <class Visit>
void forTaps(const FilterImage& image, glm::ivec2 pixel, int radius, int step, const Visit& visit) {
  const std::array<float, 3> narrow = {0.25f, 0.5f, 0.25f};
  const float* kernel = radius == kRadius ? kSpline.data() : narrow.data();
  for (int dy = -radius; dy <= radius; ++dy) {
    const int y = pixel.y + dy * step;
    if (y < 0 || y >= static_cast<int>(image.height)) continue;
    for (int dx = -radius; dx <= radius; ++dx) {
      const int x = pixel.x + dx * step;
      if (x < 0 || x >= static_cast<int>(image.width)) continue;
      visit(static_cast<size_t>(y) * image.width + static_cast<size_t>(x), kernel[dy + radius] * kernel[dx + radius]);
    }
  }
}

/// The mean variance of 3 x 3 pixels of one surface: the error of one pixel is known to a quarter of itself only, and
/// seems nil where eight replicates saw nothing.
std::vector<glm::vec3> smoothedVariance(const FilterImage& image, const std::vector<Guide>& guides, uint32_t threads) {
  std::vector<glm::vec3> result(image.variance.size());
  forRows(image.height, threads, [&](uint32_t y) {
    for (uint32_t x = 0; x < image.width; ++x) {
      const size_t p = size_t{y} * image.width + x;
      float weights = 0;
      glm::vec3 sum{0};
      forTaps(image, {x, y}, 1, 1, [&](size_t q, float kernel) {
        const float weight = q == p ? kernel : kernel * guideWeight(guides[p], guides[q]);
        weights += weight;
        sum += weight * image.variance[q];
      });
      result[p] = sum / weights;
    }
  });
  return result;
}

FilterImage filterLevel(const FilterImage& image, const std::vector<Guide>& guides, uint32_t level, uint32_t threads) {
  const float correlation = tapCorrelation(level);
  FilterImage result = image;
  forRows(image.height, threads, [&](uint32_t y) {
    for (uint32_t x = 0; x < image.width; ++x) {
      const size_t p = size_t{y} * image.width + x;
      TapSum sum;
      forTaps(image, {x, y}, kRadius, 1 << level, [&](size_t q, float kernel) {
        float weight = kernel;
        if (q != p) {
          const float color = colorDistance(image.color[p], image.variance[p], image.color[q], image.variance[q]);
          if (color > kNegligible) return;
          weight *= normalWeight(guides[p], guides[q]) * std::exp(-color - guideDistance(guides[p], guides[q]));
        }
        sum.add(weight, image.color[q], image.variance[q]);
      });
      result.color[p] = sum.color();
      result.variance[p] = sum.variance(correlation);
    }
  });
  return result;
}

} // namespace

FilterImage atrousFilter(FilterImage image, const std::vector<Guide>& guides, uint32_t threads) {
  image.variance = smoothedVariance(image, guides, threads);
  for (uint32_t level = 0; level < kLevels; ++level) image = filterLevel(image, guides, level, threads);
  return image;
}

} // namespace isophote::denoise
