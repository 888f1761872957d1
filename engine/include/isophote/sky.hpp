// A clear sky with its sun, in photometric units: cd/m^2, and lux for the sun, as glTF's lights have them.
#pragma once

#include "isophote/scene.hpp"

namespace isophote {

/// Mean angular radius of the sun as seen from the earth, radians: 0.2665 degrees.
inline constexpr float kSunAngularRadius = 0.00465130f;

struct SkyOptions {
  double elevationDegrees = 45; ///< of the sun above the horizon, [0, 90]
  double azimuthDegrees = 0;    ///< of the sun, from -z clockwise as seen from above (90: +x)
  double turbidity = 3;         ///< haze: 2 very clear to 10 hazy, the range of the fit
};

struct Sky {
  Environment environment; ///< black below the horizon
  PunctualLight sun;       ///< directional, a disk of kSunAngularRadius
};

/// Preetham, Shirley and Smits 1999, "A Practical Analytic Model for Daylight".
/// @throws Error where an option is out of its range
[[nodiscard]] Sky makeSky(const SkyOptions& options);

/// Luminance (kcd/m^2) and chromaticity (x, y) of the sky's zenith; the paper's appendix 2.
/// @param thetaSun  radians from the zenith, [0, pi / 2]
[[nodiscard]] glm::dvec3 skyZenith(double thetaSun, double turbidity);

/// CIE x, y (chromaticity) and Y (kcd/m^2) of the sky as (Y, x, y): skyZenith and Perez's five-parameter distribution.
/// @param theta  radians from the zenith, [0, pi / 2)
/// @param gamma  radians from the sun
[[nodiscard]] glm::dvec3 skyRadiance(double theta, double gamma, double thetaSun, double turbidity);

/// Illuminance of the sun on a plane that faces it, lux per channel of linear Rec.709: the paper's appendix 1 over the
/// visible wavelengths.
[[nodiscard]] glm::dvec3 sunIlluminance(double thetaSun, double turbidity);

} // namespace isophote
