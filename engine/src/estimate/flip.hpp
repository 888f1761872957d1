// LDR-FLIP: the difference a viewer sees when alternating between two images.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace isophote::estimate {

/// 0.7 m from a 0.7 m wide monitor of 3840 pixels, the paper's default observer.
inline constexpr double kDefaultPixelsPerDegree = 67.0206432766;

/// The error map of LDR-FLIP, values in [0, 1], row 0 as in the images.
///
/// Source: Andersson, Nilsson, Akenine-Moeller, Oskarsson, Astrom, Fairchild 2020, "FLIP: A Difference Evaluator for
/// Alternating Images", PACMCGIT 3(2).
/// @param test, reference  sRGB-encoded colors in [0, 1], width * height
[[nodiscard]] std::vector<float> flipMap(std::span<const glm::vec3> test, std::span<const glm::vec3> reference,
                                         uint32_t width, uint32_t height,
                                         double pixelsPerDegree = kDefaultPixelsPerDegree);

} // namespace isophote::estimate
