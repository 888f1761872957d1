// True errors of renders, measured against others of the same image.
#pragma once

#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "isophote/film.hpp"

namespace isophote::test {

/// A film's means, row by row, with all that double precision has of the sums.
struct FilmMeans {
  std::vector<glm::dvec3> pixels;
  double samples = 0; ///< a pixel
};
[[nodiscard]] FilmMeans filmMeans(const FilmSums& sums);

/// mean over pixels and channels of (a - truth)^2 / (truth^2 + e^2), e = 1% of the truth's mean luminance: the square
/// of the relative RMS error where the truth is the truth.
[[nodiscard]] double relativeMeanSquare(const FilmMeans& means, const FilmMeans& truth);

/// The relative RMS error of each render, against the mean of all others (by their samples), which must have the same
/// expectation. What these are expected to be off by is taken off again.
[[nodiscard]] std::vector<double> errorsAgainstTheOthers(std::span<const FilmMeans> renders);

} // namespace isophote::test
