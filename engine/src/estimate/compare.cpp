#include "isophote/compare.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "estimate/compare_verdict.hpp"
#include "estimate/flip.hpp"
#include "estimate/hdr_flip.hpp"
#include "isophote/error.hpp"

namespace isophote {
namespace {

struct Rgb {
  std::array<const float*, 3> planes;
  [[nodiscard]] glm::vec3 at(size_t pixel) const { return {planes[0][pixel], planes[1][pixel], planes[2][pixel]}; }
};

Rgb colorPlanes(const Image& image) {
  Rgb color{};
  constexpr std::array<const char*, 3> kNames = {"R", "G", "B"};
  for (size_t c = 0; c < 3; ++c) {
    const Channel* channel = image.find(kNames[c]);
    if (channel == nullptr) throw UsageError(std::string("cannot compare an image without channel ") + kNames[c]);
    color.planes[c] = channel->values.data();
  }
  return color;
}

/// @return relative and plain mean square difference
std::pair<double, double> meanSquares(const Rgb& test, const Rgb& reference, size_t pixels) {
  constexpr glm::dvec3 kLuminance{0.2126, 0.7152, 0.0722}; // Rec. ITU-R BT.709
  double luminance = 0;
  for (size_t i = 0; i < pixels; ++i) luminance += glm::dot(kLuminance, glm::dvec3(reference.at(i)));
  const double e = 0.01 * luminance / static_cast<double>(pixels);
  double relative = 0;
  double plain = 0;
  for (size_t i = 0; i < pixels; ++i) {
    for (size_t c = 0; c < 3; ++c) {
      const double b = reference.planes[c][i];
      const double difference = test.planes[c][i] - b;
      if (difference == 0) continue; // also 0 / 0 in a black image
      plain += difference * difference;
      relative += difference * difference / (b * b + e * e);
    }
  }
  const double count = 3.0 * static_cast<double>(pixels);
  return {relative / count, plain / count};
}

std::vector<glm::vec3> display(const Rgb& color, size_t pixels) {
  std::vector<glm::vec3> result(pixels);
  for (size_t i = 0; i < pixels; ++i) result[i] = toneMap(color.at(i), ToneMap::Neutral);
  return result;
}

/// 10 log10(1 / mean square difference) of values in [0, 1].
double psnr(const std::vector<glm::vec3>& a, const std::vector<glm::vec3>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    const glm::dvec3 difference = glm::dvec3(a[i]) - glm::dvec3(b[i]);
    sum += glm::dot(difference, difference);
  }
  return -10 * std::log10(sum / (3.0 * static_cast<double>(a.size())));
}

} // namespace

Comparison compareImages(const Image& test, const Image& reference) {
  if (test.width != reference.width || test.height != reference.height) {
    throw UsageError("cannot compare " + std::to_string(test.width) + " x " + std::to_string(test.height) + " with " +
                     std::to_string(reference.width) + " x " + std::to_string(reference.height) + " pixels");
  }
  const size_t pixels = size_t(test.width) * test.height;
  if (pixels == 0) throw UsageError("cannot compare images without pixels");
  const Rgb a = colorPlanes(test);
  const Rgb b = colorPlanes(reference);
  Comparison comparison;
  const auto [relative, plain] = meanSquares(a, b, pixels);
  comparison.relMse = relative;
  comparison.rmse = std::sqrt(plain);
  const std::vector<glm::vec3> shownA = display(a, pixels);
  const std::vector<glm::vec3> shownB = display(b, pixels);
  comparison.psnr = psnr(shownA, shownB);
  comparison.flipMap = estimate::flipMap(shownA, shownB, test.width, test.height);
  comparison.flip =
      std::accumulate(comparison.flipMap.begin(), comparison.flipMap.end(), 0.0) / static_cast<double>(pixels);
  std::vector<glm::vec3> linearA(pixels), linearB(pixels);
  for (size_t i = 0; i < pixels; ++i) {
    linearA[i] = a.at(i);
    linearB[i] = b.at(i);
  }
  const std::vector<float> hdr = estimate::hdrFlipMap(linearA, linearB, test.width, test.height);
  comparison.hdrFlip = std::accumulate(hdr.begin(), hdr.end(), 0.0) / static_cast<double>(pixels);
  comparison.verdict = estimate::compareStatistically(test, reference);
  return comparison;
}

} // namespace isophote
