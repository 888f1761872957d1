// HDR-FLIP: the difference a viewer sees at the exposure that shows it best.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace isophote::estimate {

/// Exposures in stops, from where the reference's brightest luminance is just not white to where its median is.
struct ExposureRange {
  double first = 0;
  double last = 0;
  uint32_t count = 2;
  [[nodiscard]] double at(uint32_t index) const { return first + (last - first) * index / (count - 1); }
};

/// @param reference  linear Rec.709; black where not above 0. Pixels that are black do not count for the median, so
/// that
///                   a dark background does not ask for endless exposures (the paper takes all pixels).
[[nodiscard]] ExposureRange flipExposures(std::span<const glm::vec3> reference);

/// The error map of HDR-FLIP, values in [0, 1]: of each pixel the largest LDR-FLIP over the exposures, about one a
/// stop.
///
/// Source: Andersson, Nilsson, Shirley, Akenine-Moeller 2021, "Visualizing Errors in Rendered High Dynamic Range
/// Images", Eurographics short papers; the tone mapper is its ACES (Narkowicz 2015, without the pre-exposure).
/// @param test, reference  linear Rec.709, width * height; negative values and NaN count as 0
[[nodiscard]] std::vector<float> hdrFlipMap(std::span<const glm::vec3> test, std::span<const glm::vec3> reference,
                                            uint32_t width, uint32_t height);

} // namespace isophote::estimate
