// Which pixels shall get more samples than others.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "isophote/image.hpp"

namespace isophote {

/// Pixels by how many samples each gets for one of the first class: 1, 2, 4, 8.
struct SampleAllocation {
  static constexpr uint32_t kClasses = 4;
  std::array<std::vector<uint32_t>, kClasses> pixels; ///< row by row; every pixel in one class
  double samplesPerPixel = 1;                         ///< in the mean, for one of the first class
  /// Factor by which the mean square relative error of as many samples falls against equal shares, if the pilot's
  /// error bars are the truth. They are not: they scatter, and what is chosen by them disappoints.
  double expectedGain = 1;

  [[nodiscard]] static constexpr uint32_t weight(uint32_t pixelClass) { return 1u << pixelClass; }
};

/// The least mean square relative error for a number of samples: a pixel's share is proportional to its standard
/// deviation over its value (Neyman 1934, "On the Two Different Aspects of the Representative Method", optimum
/// allocation; Mitchell 1987, "Generating Antialiased Images at Low Sampling Densities", for pixels). Deviations are
/// those of 5x5 pixels together, since those of single ones rest on few samples; none gets less than a third of the
/// mean share.
///
/// An image whose samples are chosen by their own errors is biased: pixels that looked quiet because they missed a
/// bright event stay dark. So the pilot must have other random numbers than the image, and no part in it.
/// @param pilot  with R, G, B and stderr.{R,G,B}
[[nodiscard]] SampleAllocation allocateSamples(const Image& pilot);

} // namespace isophote
