// Number 52 of the reliability list: the error falls as samples^-1/2 or faster, without a floor.
//
// Each scene is rendered to ever more samples, in small images; the relative RMS error at each power of two is against
// the closed form, or against the mean of the other seeds' most samples (which cannot see a bias that all seeds share:
// the closed forms do). By default up to 2^10 samples, where the slope's standard deviation is about 0.015 (0.03 for
// each four seeds); the slow test goes to 2^20, where it is as small.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <functional>
#include <optional>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/film_truth.hpp"
#include "support/gpu_device.hpp"
#include "support/render.hpp"
#include "support/scenes.hpp"

namespace isophote {
namespace {

using namespace isophote::test;

constexpr uint32_t kSide = 5;
constexpr uint32_t kFirst = 16;
constexpr double kSlopeTolerance = 0.05;
constexpr uint32_t kDefaultSeeds = 16;
/// Below this relative error single precision shows: no scene is held to fall further.
constexpr double kFloatFloor = kRounding;

struct ConvergenceScene {
  const char* name;
  std::function<Scene()> scene;
  Camera camera;
  std::optional<double> radiance; ///< of every channel and pixel
  uint32_t maxDepth = kUnlimitedDepth;
};

const std::vector<ConvergenceScene>& convergenceScenes() {
  const Camera sensor = sensorAt({0, 0, 0});
  static const std::vector<ConvergenceScene> scenes = {
      {"furnace", [] { return boxFurnace(glm::vec3(1), glm::vec3(0.5f)); }, boxFurnaceCamera(), 2.0},
      {"square light", [] { return squareLightOverFloor(2); }, sensor, 2 * 0.2394564705, 1},
      {"sphere light", [] { return floorUnderASphere(1); }, sensor, 0.25, 1},
      {"sky", floorUnderAHalfBrightSky, sensor, 1.0, 1},
      {"Cornell box", cornellBox, cornellCamera(), std::nullopt},
      {"glossy spheres", materialSpheres, materialSpheresCamera(), std::nullopt},
      {"textures", texturedStillLife, texturedStillLifeCamera(), std::nullopt},
      {"instances", instanceGrid, instanceGridCamera(), std::nullopt}};
  return scenes;
}

/// log2 of samples and of the RMS error over all seeds.
struct ErrorPoint {
  double logSamples = 0;
  double logError = 0;
};

std::vector<ErrorPoint> errorCurve(const ConvergenceScene& scene, SamplerKind sampler, uint32_t last, uint32_t seeds) {
  const GpuScene gpuScene(gpuDevice(), scene.scene());
  PathTracer tracer(gpuDevice(), gpuScene,
                    {.sampler = sampler, .filter = PixelFilter::Box, .maxDepth = scene.maxDepth});
  std::vector<std::vector<FilmMeans>> means(seeds); // by seed, then by power of two
  for (uint32_t seed = 0; seed < seeds; ++seed) {
    Film film(gpuDevice(), {.width = kSide, .height = kSide, .aovs = false});
    tracer.setSeed(seed);
    uint32_t done = 0;
    for (uint32_t samples = kFirst; samples <= last; samples *= 2) {
      tracer.render(scene.camera, film, {done, samples});
      done = samples;
      means[seed].push_back(filmMeans(film.sums()));
    }
  }
  expectHealthy(tracer.statistics());
  std::vector<ErrorPoint> curve;
  for (size_t power = 0; power < means[0].size(); ++power) {
    double square = 0;
    for (uint32_t seed = 0; seed < seeds; ++seed) {
      FilmMeans truth{.pixels = std::vector<glm::dvec3>(size_t{kSide} * kSide, glm::dvec3(scene.radiance.value_or(0)))};
      double off = 0; // what the truth's own error adds
      if (!scene.radiance) {
        for (uint32_t other = 0; other < seeds; ++other) {
          if (other == seed) continue;
          for (size_t i = 0; i < truth.pixels.size(); ++i)
            truth.pixels[i] += means[other].back().pixels[i] / double(seeds - 1);
        }
        off = means[seed][power].samples / (means[seed].back().samples * (seeds - 1));
      }
      square += relativeMeanSquare(means[seed][power], truth) / (1 + off) / seeds;
    }
    curve.push_back({std::log2(means[0][power].samples), 0.5 * std::log2(square)});
  }
  std::erase_if(curve, [](const ErrorPoint& point) { return point.logError < std::log2(kFloatFloor); });
  return curve;
}

/// Least squares through the points from `first` on.
double slope(const std::vector<ErrorPoint>& curve, size_t first = 0) {
  double x = 0, y = 0, xx = 0, xy = 0;
  const auto count = static_cast<double>(curve.size() - first);
  for (size_t i = first; i < curve.size(); ++i) {
    x += curve[i].logSamples / count;
    y += curve[i].logError / count;
  }
  for (size_t i = first; i < curve.size(); ++i) {
    xx += (curve[i].logSamples - x) * (curve[i].logSamples - x);
    xy += (curve[i].logSamples - x) * (curve[i].logError - y);
  }
  return xy / xx;
}

void expectConvergence(const ConvergenceScene& scene, SamplerKind sampler, uint32_t last, uint32_t seeds) {
  const std::vector<ErrorPoint> curve = errorCurve(scene, sampler, last, seeds);
  ASSERT_GE(curve.size(), 4u) << scene.name << ": the error is below that of single precision from the beginning";
  const double whole = slope(curve);
  EXPECT_LE(whole, -0.5 + kSlopeTolerance) << scene.name;
  if (sampler == SamplerKind::Independent) {
    EXPECT_GE(whole, -0.5 - kSlopeTolerance) << scene.name;
  }
  // A floor would show in the last octaves. Few points scatter more.
  const double tail = slope(curve, curve.size() - std::min<size_t>(curve.size(), 6));
  EXPECT_LE(tail, -0.5 + 4 * kSlopeTolerance) << scene.name;
  fmt::print("{:<15} {:<11} slope {:.3f}, of the last octaves {:.3f}; error {:.2e} after 2^{:.0f} samples\n",
             scene.name, sampler == SamplerKind::Sobol ? "sobol" : "independent", whole, tail,
             std::exp2(curve.back().logError), curve.back().logSamples);
}

TEST(Convergence, Test52ErrorsFallAsTheSquareRootOfTheSamplesOrFaster) {
  for (const size_t scene : {0, 1}) {
    expectConvergence(convergenceScenes()[scene], SamplerKind::Sobol, 1u << 10, kDefaultSeeds);
    expectConvergence(convergenceScenes()[scene], SamplerKind::Independent, 1u << 10, kDefaultSeeds);
  }
}

TEST(ConvergenceSlow, Test52UpToAMillionSamplesOnEightScenes) {
  for (const ConvergenceScene& scene : convergenceScenes()) {
    expectConvergence(scene, SamplerKind::Sobol, 1u << 20, 2);
    expectConvergence(scene, SamplerKind::Independent, 1u << 14, 4);
  }
}

} // namespace
} // namespace isophote
