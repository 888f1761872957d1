#include "isophote/sky.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <glm/gtc/constants.hpp>

#include "isophote/error.hpp"
#include "scene/sun_spectrum.hpp"

namespace isophote {
namespace {

constexpr double kPi = glm::pi<double>();
constexpr uint32_t kWidth = 512; // 0.7 degrees: the fit is smooth, its narrowest feature 10 degrees wide
constexpr uint32_t kHeight = kWidth / 2;

/// Perez's coefficients A to E: each is slope * turbidity + offset.
struct PerezRow {
  std::array<double, 5> slope;
  std::array<double, 5> offset;
};
// Preetham et al. 1999, appendix 2, for Y, x and y.
constexpr std::array<PerezRow, 3> kPerez{{
    {{0.1787, -0.3554, -0.0227, 0.1206, -0.0670}, {-1.4630, 0.4275, 5.3251, -2.5771, 0.3703}},
    {{-0.0193, -0.0665, -0.0004, -0.0641, -0.0033}, {-0.2592, 0.0008, 0.2125, -0.8989, 0.0452}},
    {{-0.0167, -0.0950, -0.0079, -0.0441, -0.0109}, {-0.2608, 0.0092, 0.2102, -1.6537, 0.0529}},
}};

// Rows: turbidity squared, turbidity, 1; columns: thetaSun cubed, squared, thetaSun, 1.
using Chromaticity = std::array<std::array<double, 4>, 3>;
constexpr Chromaticity kZenithX{
    {{0.00166, -0.00375, 0.00209, 0}, {-0.02903, 0.06377, -0.03202, 0.00394}, {0.11693, -0.21196, 0.06052, 0.25886}}};
constexpr Chromaticity kZenithY{
    {{0.00275, -0.00610, 0.00317, 0}, {-0.04214, 0.08970, -0.04153, 0.00516}, {0.15346, -0.26756, 0.06670, 0.26688}}};

double zenithChromaticity(const Chromaticity& rows, double thetaSun, double turbidity) {
  double result = 0;
  for (const auto& row : rows) {
    const double cubic = ((row[0] * thetaSun + row[1]) * thetaSun + row[2]) * thetaSun + row[3];
    result = result * turbidity + cubic;
  }
  return result;
}

double perez(const PerezRow& row, double theta, double gamma, double turbidity) {
  std::array<double, 5> c{};
  for (size_t i = 0; i < c.size(); ++i) c[i] = row.slope[i] * turbidity + row.offset[i];
  const double cosGamma = std::cos(gamma);
  return (1 + c[0] * std::exp(c[1] / std::cos(theta))) *
         (1 + c[2] * std::exp(c[3] * gamma) + c[4] * cosGamma * cosGamma);
}

void requireRange(double value, double lower, double upper, const char* name) {
  if (value >= lower && value <= upper) return;
  throw Error(std::string("the sky's ") + name + " is not between " + std::to_string(lower) + " and " +
              std::to_string(upper));
}

glm::dvec3 fromXyY(const glm::dvec3& luminanceAndChromaticity) {
  const double luminance = luminanceAndChromaticity[0];
  const double x = luminanceAndChromaticity[1];
  const double y = luminanceAndChromaticity[2];
  return rec709FromXyz({x / y * luminance, luminance, (1 - x - y) / y * luminance});
}

} // namespace

glm::dvec3 skyZenith(double thetaSun, double turbidity) {
  const double chi = (4.0 / 9 - turbidity / 120) * (kPi - 2 * thetaSun);
  return {(4.0453 * turbidity - 4.9710) * std::tan(chi) - 0.2155 * turbidity + 2.4192,
          zenithChromaticity(kZenithX, thetaSun, turbidity), zenithChromaticity(kZenithY, thetaSun, turbidity)};
}

glm::dvec3 skyRadiance(double theta, double gamma, double thetaSun, double turbidity) {
  glm::dvec3 result = skyZenith(thetaSun, turbidity);
  for (int i = 0; i < 3; ++i) {
    const PerezRow& row = kPerez[static_cast<size_t>(i)];
    result[i] *= perez(row, theta, gamma, turbidity) / perez(row, 0, thetaSun, turbidity);
  }
  return result;
}

Sky makeSky(const SkyOptions& options) {
  requireRange(options.elevationDegrees, 0, 90, "elevation");
  requireRange(options.turbidity, 2, 10, "turbidity");
  const double elevation = glm::radians(options.elevationDegrees);
  const double azimuth = glm::radians(options.azimuthDegrees);
  const double thetaSun = kPi / 2 - elevation;
  const glm::dvec3 toSun(std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                         -std::cos(elevation) * std::cos(azimuth));
  Sky sky;
  sky.environment.width = kWidth;
  sky.environment.height = kHeight;
  sky.environment.pixels.assign(size_t{kWidth} * kHeight, glm::vec3(0));
  for (uint32_t row = 0; row < kHeight / 2; ++row) {
    const double theta = kPi * (row + 0.5) / kHeight;
    for (uint32_t column = 0; column < kWidth; ++column) {
      const double phi = 2 * kPi * ((column + 0.5) / kWidth - 0.5);
      const glm::dvec3 direction(std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi));
      const double gamma = std::acos(std::clamp(glm::dot(direction, toSun), -1.0, 1.0));
      const glm::dvec3 color = 1000.0 * fromXyY(skyRadiance(theta, gamma, thetaSun, options.turbidity));
      sky.environment.pixels[size_t{row} * kWidth + column] = glm::max(glm::vec3(color), glm::vec3(0));
    }
  }
  sky.sun.name = "sun";
  sky.sun.kind = LightKind::Directional;
  sky.sun.intensity = glm::vec3(sunIlluminance(thetaSun, options.turbidity));
  sky.sun.direction = -toSun;
  sky.sun.radius = kSunAngularRadius;
  return sky;
}

} // namespace isophote
