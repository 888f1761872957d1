#include "estimate/hdr_flip.hpp"

#include <algorithm>
#include <cmath>

#include "estimate/flip.hpp"

namespace isophote::estimate {
namespace {

constexpr double kWhite = 0.85; // t of the paper: where the tone mapped luminance counts as just not white
constexpr uint32_t kMostExposures = 40;
constexpr double kLargest = 65536; // radiance beyond is white at every exposure that matters

// y = (k0 x^2 + k1 x) / (k3 x^2 + k4 x + k5)
constexpr double k0 = 0.6 * 0.6 * 2.51, k1 = 0.6 * 0.03, k3 = 0.6 * 0.6 * 2.43, k4 = 0.6 * 0.59, k5 = 0.14;

double toneMapped(double x) { return std::clamp((k0 * x * x + k1 * x) / (k3 * x * x + k4 * x + k5), 0.0, 1.0); }

/// The x with toneMapped(x) = kWhite.
double whiteInput() {
  const double a = k0 - kWhite * k3, b = k1 - kWhite * k4, c = -kWhite * k5;
  return (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a);
}

double encodeSrgb(double x) { return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055; }

glm::dvec3 usable(glm::vec3 color) {
  glm::dvec3 result;
  for (int c = 0; c < 3; ++c) result[c] = color[c] > 0 ? std::min<double>(color[c], kLargest) : 0; // NaN is not above 0
  return result;
}

std::vector<glm::vec3> exposed(std::span<const glm::vec3> image, double stops) {
  const double factor = std::exp2(stops);
  std::vector<glm::vec3> result(image.size());
  for (size_t i = 0; i < image.size(); ++i) {
    const glm::dvec3 color = usable(image[i]);
    for (int c = 0; c < 3; ++c) result[i][c] = static_cast<float>(encodeSrgb(toneMapped(factor * color[c])));
  }
  return result;
}

} // namespace

ExposureRange flipExposures(std::span<const glm::vec3> reference) {
  std::vector<double> luminances;
  for (const glm::vec3 color : reference) {
    const double luminance = glm::dot(usable(color), glm::dvec3(0.2126, 0.7152, 0.0722)); // Rec. ITU-R BT.709
    if (luminance > 0) luminances.push_back(luminance);
  }
  if (luminances.empty()) return {};
  const double brightest = *std::max_element(luminances.begin(), luminances.end());
  const auto middle = luminances.begin() + static_cast<std::ptrdiff_t>(luminances.size() / 2);
  std::nth_element(luminances.begin(), middle, luminances.end());
  const double first = std::log2(whiteInput() / brightest), last = std::log2(whiteInput() / *middle);
  const double count = std::clamp(std::ceil(last - first), 2.0, double(kMostExposures));
  return {.first = first, .last = last, .count = static_cast<uint32_t>(count)};
}

std::vector<float> hdrFlipMap(std::span<const glm::vec3> test, std::span<const glm::vec3> reference, uint32_t width,
                              uint32_t height) {
  const ExposureRange exposures = flipExposures(reference);
  std::vector<float> largest(reference.size(), 0.0f);
  for (uint32_t i = 0; i < exposures.count; ++i) {
    const double stops = exposures.at(i);
    const std::vector<float> map = flipMap(exposed(test, stops), exposed(reference, stops), width, height);
    for (size_t p = 0; p < map.size(); ++p) largest[p] = std::max(largest[p], map[p]);
  }
  return largest;
}

} // namespace isophote::estimate
