// Colors of spectra, for the sun.
#pragma once

#include <glm/glm.hpp>

namespace isophote {

/// Linear Rec.709 with the white point D65 from CIE XYZ. IEC 61966-2-1.
[[nodiscard]] glm::dvec3 rec709FromXyz(const glm::dvec3& xyz);

/// CIE 1931 color matching functions at a wavelength in nm: Wyman, Sloan and Shirley 2013, "Simple Analytic
/// Approximations to the CIE XYZ Color Matching Functions", the fit of several lobes.
[[nodiscard]] glm::dvec3 colorMatching(double nanometers);

} // namespace isophote
