// Pixel filters as inverse cumulative distributions.
#pragma once

#include <vector>

#include "isophote/settings.hpp"

namespace isophote {

/// Distance from the pixel's center at which the filter ends, in pixels.
[[nodiscard]] double filterRadius(PixelFilter filter);

/// Unnormalised weight of the filter at `x` pixels from the center, along one axis; 0 beyond filterRadius.
///   Box:             1 pixel wide.
///   Gaussian:        standard deviation 0.5, cut at 2 pixels (4 deviations).
///   BlackmanHarris:  4-term window (Harris 1978, "On the Use of Windows for Harmonic Analysis", minimum 4-term) over 3
///                    pixels, which is Cycles' filter of width 1.5.
[[nodiscard]] double filterWeight(PixelFilter filter, double x);

/// Share of the filter's weight on [-filterRadius, x].
[[nodiscard]] double filterCdf(PixelFilter filter, double x);

/// gpu::kFilterTableSize offsets: entry i solves filterCdf(x) = i / (size - 1). Antisymmetric to the bit.
[[nodiscard]] std::vector<float> filterTable(PixelFilter filter);

} // namespace isophote
