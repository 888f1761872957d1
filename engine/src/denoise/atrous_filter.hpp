// The edge-avoiding a-trous wavelet filter of Dammertz et al. 2010 ("Edge-Avoiding A-Trous Wavelet Transform for fast
// Global Illumination Filtering"), guided by what the first hit is and by the standard error of the pixels.
//
// Each of five levels averages 5 x 5 taps, 1, 2, 4, 8 and 16 pixels apart, by the weights of a cubic B-spline times
// what four edge-stopping functions leave of them: of normals (Schied et al. 2017, "Spatiotemporal Variance-Guided
// Filtering", eq. 4), of the tangent planes, of albedo and coverage, and of color.
//
// Colors p and q may differ by what their noise explains: exp(-d^2 / (2 * 2 J)) with J = v_p + min(v_p, v_q), the joint
// variance of Rousselle et al. 2012 ("Adaptive Rendering with Non-Local Means Filtering", eq. 4), in which a bright
// outlier q does not excuse itself. So a pixel moves by less than its standard error, save one that stands out alone by
// a few errors, and a converged image is left alone. Against J itself less noise would go: measured with scenes of
// assets/ at 16 samples, 1.2 to 1.3 times the squared error.
//
// Variance is carried from level to level. Taps of a later level share pixels: taken as independent, the last level
// would be held to be ten times less noisy than it is. Their mean correlation is that of the filter on a flat wall.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace isophote::denoise {

inline constexpr uint32_t kLevels = 5;

/// What the first hits in a pixel are.
struct Guide {
  glm::vec3 albedo{0};   ///< of the samples that met a surface
  glm::vec3 normal{0};   ///< unit, or 0 where nothing was hit
  glm::vec3 position{0}; ///< mean of the hits, in metres
  float coverage = 0;    ///< share of the samples that met a surface
  bool empty = false;    ///< no samples: neither filtered nor used
};

/// Row 0 at the top, `width * height` values each.
struct FilterImage {
  uint32_t width = 0;
  uint32_t height = 0;
  std::vector<glm::vec3> color;
  std::vector<glm::vec3> variance; ///< of the colors, 0 or more
};

/// The filtered colors with the variance that they are left with. Rows are shared out over `threads` (0: as many as the
/// machine has); the result is the same for any number.
/// @param guides  one for each pixel
[[nodiscard]] FilterImage atrousFilter(FilterImage image, const std::vector<Guide>& guides, uint32_t threads = 0);

} // namespace isophote::denoise
