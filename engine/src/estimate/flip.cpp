// Section, equation and table numbers are those of the paper named in flip.hpp.
#include "estimate/flip.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "estimate/flip_filter.hpp"

namespace isophote::estimate {
namespace {

constexpr double kColorExponent = 0.7;   // q_c, Eq. 8
constexpr double kFeatureExponent = 0.5; // q_f, Eq. 10
constexpr double kKnee = 0.4;            // p_c: share of the largest color error where the slope changes, Section 4.1.3
constexpr double kKneeError = 0.95;      // p_t: error at the knee
constexpr double kFeatureWidth = 0.082;  // w, degrees from peak to trough of the edge detector, Section 4.2
constexpr glm::dvec3 kWhite{0.950428545, 1.0, 1.088900371}; // D65 of the matrix below

using Opponent = std::array<Plane, 3>; // Y_y, C_x, C_z

double decodeSrgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

/// Linear Rec.709 to CIE XYZ, the exact rational matrix for the sRGB primaries and D65.
const glm::dmat3& xyzFromRgb() {
  static const glm::dmat3 matrix =
      glm::transpose(glm::dmat3(10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794, //
                                2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897,   //
                                1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382));
  return matrix;
}

glm::dvec3 opponentFromRgb(glm::dvec3 rgb) {
  const glm::dvec3 xyz = xyzFromRgb() * rgb / kWhite;
  return {116 * xyz.y - 16, 500 * (xyz.x - xyz.y), 200 * (xyz.y - xyz.z)};
}

glm::dvec3 rgbFromOpponent(glm::dvec3 opponent) {
  static const glm::dmat3 rgbFromXyz = glm::inverse(xyzFromRgb());
  const double y = (opponent.x + 16) / 116;
  return rgbFromXyz * (glm::dvec3(y + opponent.y / 500, y, y - opponent.z / 200) * kWhite);
}

/// CIELAB with the Hunt effect: chroma scaled by 0.01 L* (Eq. 5).
glm::dvec3 huntLab(glm::dvec3 rgb) {
  constexpr double kDelta = 6.0 / 29;
  const auto compress = [](double t) {
    return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0 / 29;
  };
  const glm::dvec3 xyz = xyzFromRgb() * rgb / kWhite;
  const double y = compress(xyz.y);
  const double lightness = 116 * y - 16;
  return {lightness, 0.01 * lightness * 500 * (compress(xyz.x) - y), 0.01 * lightness * 200 * (y - compress(xyz.z))};
}

/// Abasi et al. 2020: city block in lightness, Euclidean in chroma (Eq. 6).
double hyab(glm::dvec3 a, glm::dvec3 b) { return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z); }

Opponent toOpponent(std::span<const glm::vec3> encoded, uint32_t width, uint32_t height) {
  Opponent planes;
  for (Plane& plane : planes) plane = {width, height, std::vector<float>(encoded.size())};
  for (size_t i = 0; i < encoded.size(); ++i) {
    const glm::dvec3 color = glm::clamp(glm::dvec3(encoded[i]), 0.0, 1.0);
    const glm::dvec3 opponent = opponentFromRgb({decodeSrgb(color.r), decodeSrgb(color.g), decodeSrgb(color.b)});
    for (int c = 0; c < 3; ++c) planes[static_cast<size_t>(c)].values[i] = static_cast<float>(opponent[c]);
  }
  return planes;
}

/// One term a sqrt(pi / b) exp(-pi^2 x^2 / b) of a contrast sensitivity function, x in degrees (Table 1).
struct SensitivityTerm {
  double a, b;
};

/// The standard deviation of a term's Gaussian in pixels: pi^2 / (b ppd^2) = 1 / (2 s^2).
double deviation(const SensitivityTerm& term, double pixelsPerDegree) {
  return std::sqrt(term.b / (2 * std::numbers::pi * std::numbers::pi)) * pixelsPerDegree;
}

/// Filters with the sum of the terms, normalized to unit sum over the square of `radius`.
Plane filterSensitivity(const Plane& plane, std::span<const SensitivityTerm> terms, double pixelsPerDegree,
                        int radius) {
  std::vector<double> shares;
  double total = 0;
  for (const SensitivityTerm& term : terms) {
    const double s = deviation(term, pixelsPerDegree);
    double sum = 0; // of the unnormalized one-dimensional Gaussian; squared for two dimensions
    for (int x = -radius; x <= radius; ++x) sum += std::exp(-0.5 * x * x / (s * s));
    shares.push_back(term.a * std::sqrt(std::numbers::pi / term.b) * sum * sum);
    total += shares.back();
  }
  Plane result{plane.width, plane.height, std::vector<float>(plane.values.size())};
  for (size_t i = 0; i < terms.size(); ++i) {
    const Kernel1d kernel = gaussian(deviation(terms[i], pixelsPerDegree), radius);
    const Plane part = filter(plane, kernel, kernel);
    const float share = static_cast<float>(shares[i] / total);
    for (size_t p = 0; p < part.values.size(); ++p) result.values[p] += share * part.values[p];
  }
  return result;
}

Opponent filterContrast(const Opponent& image, double pixelsPerDegree) {
  static constexpr std::array<SensitivityTerm, 1> kAchromatic{{{1, 0.0047}}};
  static constexpr std::array<SensitivityTerm, 1> kRedGreen{{{1, 0.0053}}};
  static constexpr std::array<SensitivityTerm, 2> kBlueYellow{{{34.1, 0.04}, {13.5, 0.025}}};
  const int radius = static_cast<int>(std::ceil(3 * deviation(kBlueYellow[0], pixelsPerDegree)));
  return {filterSensitivity(image[0], kAchromatic, pixelsPerDegree, radius),
          filterSensitivity(image[1], kRedGreen, pixelsPerDegree, radius),
          filterSensitivity(image[2], kBlueYellow, pixelsPerDegree, radius)};
}

/// Maps [0, largest] to [0, 1], with the knee of Section 4.1.3.
double redistribute(double error, double largest) {
  const double knee = kKnee * largest;
  if (error < knee) return kKneeError / knee * error;
  return kKneeError + (error - knee) / (largest - knee) * (1 - kKneeError);
}

glm::dvec3 perceived(const Opponent& filtered, size_t pixel) {
  const glm::dvec3 rgb =
      rgbFromOpponent({filtered[0].values[pixel], filtered[1].values[pixel], filtered[2].values[pixel]});
  return huntLab(glm::clamp(rgb, 0.0, 1.0));
}

std::vector<float> colorErrors(const Opponent& test, const Opponent& reference, double pixelsPerDegree) {
  const Opponent a = filterContrast(test, pixelsPerDegree);
  const Opponent b = filterContrast(reference, pixelsPerDegree);
  const double largest = std::pow(hyab(huntLab({0, 1, 0}), huntLab({0, 0, 1})), kColorExponent);
  std::vector<float> errors(a[0].values.size());
  for (size_t i = 0; i < errors.size(); ++i) {
    errors[i] =
        static_cast<float>(redistribute(std::pow(hyab(perceived(a, i), perceived(b, i)), kColorExponent), largest));
  }
  return errors;
}

struct Features {
  std::vector<float> edges;
  std::vector<float> points;
};

Features findFeatures(const Plane& achromatic, double pixelsPerDegree) {
  Plane lightness = achromatic;
  for (float& value : lightness.values) value = (value + 16) / 116;
  const double s = 0.5 * kFeatureWidth * pixelsPerDegree;
  const int radius = static_cast<int>(std::ceil(3 * s));
  const Kernel1d smooth = gaussian(s, radius);
  const auto strength = [&](const Kernel1d& detector) {
    const Plane x = filter(lightness, detector, smooth);
    const Plane y = filter(lightness, smooth, detector);
    std::vector<float> result(x.values.size());
    for (size_t i = 0; i < result.size(); ++i) result[i] = std::hypot(x.values[i], y.values[i]);
    return result;
  };
  return {strength(gaussianFirstDerivative(s, radius)), strength(gaussianSecondDerivative(s, radius))};
}

} // namespace

std::vector<float> flipMap(std::span<const glm::vec3> test, std::span<const glm::vec3> reference, uint32_t width,
                           uint32_t height, double pixelsPerDegree) {
  const Opponent a = toOpponent(test, width, height);
  const Opponent b = toOpponent(reference, width, height);
  std::vector<float> errors = colorErrors(a, b, pixelsPerDegree);
  const Features featuresA = findFeatures(a[0], pixelsPerDegree);
  const Features featuresB = findFeatures(b[0], pixelsPerDegree);
  for (size_t i = 0; i < errors.size(); ++i) {
    const double feature = std::max(std::abs(featuresA.edges[i] - featuresB.edges[i]),
                                    std::abs(featuresA.points[i] - featuresB.points[i]));
    const double featureError = std::pow(feature / std::numbers::sqrt2, kFeatureExponent);
    errors[i] = static_cast<float>(std::pow(double(errors[i]), 1 - std::min(featureError, 1.0))); // Eq. 11
  }
  return errors;
}

} // namespace isophote::estimate
