#include "scene/sun_spectrum.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include <glm/gtc/constants.hpp>

#include "isophote/sky.hpp"

namespace isophote {
namespace {

/// One value of a table, linear between them and constant beyond its ends.
struct Entry {
  double nanometers;
  double value;
};

double at(std::span<const Entry> table, double nanometers) {
  if (nanometers <= table.front().nanometers) return table.front().value;
  for (size_t i = 1; i < table.size(); ++i) {
    if (nanometers > table[i].nanometers) continue;
    const Entry& a = table[i - 1];
    const Entry& b = table[i];
    return a.value + (b.value - a.value) * (nanometers - a.nanometers) / (b.nanometers - a.nanometers);
  }
  return table.back().value;
}

// Preetham et al. 1999, table 2, after Iqbal 1983, "An Introduction to Solar Radiation". The sun outside the atmosphere
// in 100 W / (m^2 nm sr), 380 to 750 nm in steps of 10.
constexpr std::array<double, 38> kSolar{165.5, 162.3, 211.2, 258.8, 258.2, 242.3, 267.6, 296.6, 305.4, 300.6,
                                        306.6, 288.3, 287.1, 278.2, 271.0, 272.3, 263.6, 255.0, 250.6, 253.1,
                                        253.5, 251.3, 246.3, 241.7, 236.8, 232.1, 228.2, 223.4, 219.7, 215.3,
                                        211.0, 207.3, 202.4, 198.7, 194.3, 190.7, 186.3, 182.6};
constexpr double kSolarFirst = 380;
constexpr double kSolarStep = 10;
constexpr double kSolarUnit = 100;
// Absorption of ozone, 1/cm.
constexpr std::array<Entry, 37> kOzone{
    {{445, .003}, {450, .003}, {455, .004}, {460, .006}, {465, .008}, {470, .009}, {475, .012}, {480, .014},
     {485, .017}, {490, .021}, {495, .025}, {500, .030}, {505, .035}, {510, .040}, {515, .045}, {520, .048},
     {525, .057}, {530, .063}, {535, .070}, {540, .075}, {545, .080}, {550, .085}, {555, .095}, {560, .103},
     {565, .110}, {570, .120}, {575, .122}, {580, .120}, {590, .115}, {600, .125}, {605, .130}, {620, .105},
     {640, .079}, {660, .057}, {700, .023}, {740, .010}, {750, .009}}};
// Absorption of water vapor, 1/cm. Mixed gases absorb above 759 nm only.
constexpr std::array<Entry, 8> kWater{
    {{689, 0}, {690, .016}, {700, .024}, {710, .0125}, {720, 1}, {730, .87}, {740, .061}, {750, .001}}};

constexpr double kOzoneCentimeters = 0.35;
constexpr double kWaterCentimeters = 2;
constexpr double kAngstromAlpha = 1.3;
constexpr double kSunRadius = 0.00465; // radians, half the mean apparent diameter of 0.533 degrees
constexpr double kLumensPerWatt = 683; // at the peak of the photopic curve

/// Share of the sun's light that arrives, appendix 1.
double transmittance(double nanometers, double airMass, double turbidity) {
  const double micrometers = nanometers / 1000;
  const double beta = 0.04608365822050 * turbidity - 0.04586025928522;
  const double rayleigh = std::exp(-0.008735 * std::pow(micrometers, -4.08) * airMass);
  const double aerosol = std::exp(-beta * std::pow(micrometers, -kAngstromAlpha) * airMass);
  const double ozone = std::exp(-at(kOzone, nanometers) * kOzoneCentimeters * airMass);
  const double wet = at(kWater, nanometers) * kWaterCentimeters * airMass;
  const double water = std::exp(-0.2385 * wet / std::pow(1 + 20.07 * wet, 0.45));
  return rayleigh * aerosol * ozone * water;
}

double lobe(double nanometers, double center, double below, double above) {
  const double t = (nanometers - center) * (nanometers < center ? below : above);
  return std::exp(-0.5 * t * t);
}

} // namespace

glm::dvec3 rec709FromXyz(const glm::dvec3& xyz) {
  return {3.2404542 * xyz.x - 1.5371385 * xyz.y - 0.4985314 * xyz.z,
          -0.9692660 * xyz.x + 1.8760108 * xyz.y + 0.0415560 * xyz.z,
          0.0556434 * xyz.x - 0.2040259 * xyz.y + 1.0572252 * xyz.z};
}

glm::dvec3 colorMatching(double nm) {
  return {0.362 * lobe(nm, 442.0, 0.0624, 0.0374) + 1.056 * lobe(nm, 599.8, 0.0264, 0.0323) -
              0.065 * lobe(nm, 501.1, 0.0490, 0.0382),
          0.821 * lobe(nm, 568.8, 0.0213, 0.0247) + 0.286 * lobe(nm, 530.9, 0.0613, 0.0322),
          1.217 * lobe(nm, 437.0, 0.0845, 0.0278) + 0.681 * lobe(nm, 459.0, 0.0385, 0.0725)};
}

glm::dvec3 sunIlluminance(double thetaSun, double turbidity) {
  const double degrees = glm::degrees(thetaSun);
  const double airMass = 1 / (std::cos(thetaSun) + 0.15 * std::pow(93.885 - degrees, -1.253));
  glm::dvec3 xyz(0);
  for (size_t i = 0; i < kSolar.size(); ++i) {
    const double nanometers = kSolarFirst + kSolarStep * static_cast<double>(i);
    const double radiance = kSolar[i] * kSolarUnit * transmittance(nanometers, airMass, turbidity);
    xyz += kSolarStep * radiance * colorMatching(nanometers);
  }
  const double solidAngle = glm::pi<double>() * kSunRadius * kSunRadius;
  return glm::max(kLumensPerWatt * solidAngle * rec709FromXyz(xyz), glm::dvec3(0));
}

} // namespace isophote
