#include "isophote/sample_allocation.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "isophote/error.hpp"

namespace isophote {
namespace {

constexpr int kRadius = 2;
constexpr double kLeastShare = 1.0 / 3;

const std::vector<float>& valuesOf(const Image& image, const std::string& name) {
  const Channel* channel = image.find(name);
  if (channel == nullptr) throw UsageError("the pilot has no channel " + name);
  return channel->values;
}

/// Sum over channels of Var[mean] / (mean^2 + e^2), e = 1% of the mean luminance, by pixel.
std::vector<double> relativeVariances(const Image& pilot) {
  const auto &red = valuesOf(pilot, "R"), &green = valuesOf(pilot, "G"), &blue = valuesOf(pilot, "B");
  double luminance = 0;
  for (size_t i = 0; i < red.size(); ++i)
    luminance += 0.2126 * double(red[i]) + 0.7152 * double(green[i]) + 0.0722 * double(blue[i]);
  const double e = 0.01 * luminance / static_cast<double>(std::max<size_t>(red.size(), 1));
  std::vector<double> variances(red.size());
  for (const std::string color : {"R", "G", "B"}) {
    const auto &mean = valuesOf(pilot, color), &error = valuesOf(pilot, "stderr." + color);
    for (size_t i = 0; i < variances.size(); ++i) {
      const double scale = double(mean[i]) * double(mean[i]) + e * e;
      if (scale > 0 && std::isfinite(error[i])) variances[i] += double(error[i]) * double(error[i]) / scale;
    }
  }
  return variances;
}

/// The mean over each pixel's neighborhood.
std::vector<double> smoothed(const std::vector<double>& values, uint32_t width, uint32_t height) {
  std::vector<double> result(values.size());
  const auto w = static_cast<int>(width), h = static_cast<int>(height);
  for (int y = 0; y < h; ++y) {
    for (int x = 0; x < w; ++x) {
      double sum = 0;
      int count = 0;
      for (int v = std::max(y - kRadius, 0); v <= std::min(y + kRadius, h - 1); ++v) {
        for (int u = std::max(x - kRadius, 0); u <= std::min(x + kRadius, w - 1); ++u, ++count)
          sum += values[static_cast<size_t>(v * w + u)];
      }
      result[static_cast<size_t>(y * w + x)] = sum / count;
    }
  }
  return result;
}

} // namespace

SampleAllocation allocateSamples(const Image& pilot) {
  const std::vector<double> variances = smoothed(relativeVariances(pilot), pilot.width, pilot.height);
  double meanDeviation = 0;
  for (const double variance : variances) meanDeviation += std::sqrt(variance) / static_cast<double>(variances.size());
  SampleAllocation allocation;
  double samples = 0, equal = 0, shared = 0;
  for (uint32_t i = 0; i < variances.size(); ++i) {
    const double share = meanDeviation > 0 ? std::sqrt(variances[i]) / meanDeviation : 1;
    const double power = std::round(std::log2(std::max(share / kLeastShare, 1.0)));
    const uint32_t pixelClass = std::min(static_cast<uint32_t>(power), SampleAllocation::kClasses - 1);
    allocation.pixels[pixelClass].push_back(i);
    samples += SampleAllocation::weight(pixelClass);
    equal += variances[i];
    shared += variances[i] / SampleAllocation::weight(pixelClass);
  }
  if (variances.empty()) return allocation;
  allocation.samplesPerPixel = samples / static_cast<double>(variances.size());
  if (shared > 0) allocation.expectedGain = equal / (shared * allocation.samplesPerPixel);
  return allocation;
}

} // namespace isophote
