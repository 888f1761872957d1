// The comparisons of the course that the project grew from: PA213, "Monte Carlo Rendering" (J. Byska, after K. Crane).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "trade/configuration.hpp"

namespace isophote::cli {

/// One picture of a comparison, of a variant of assets/lecture.glb.
struct CourseFigure {
  std::string caption;
  std::string variant;
  Configuration configuration; ///< with its max-depth
  uint32_t samples = 100;
  double reflectedTimes = 1; ///< of one-bounce figures: a wrong factor of the reflected light
};

struct CourseComparison {
  std::string title;
  std::string remark;
  std::vector<CourseFigure> figures;
};

/// Those whose settings this build has.
[[nodiscard]] std::vector<CourseComparison> courseComparisons();

} // namespace isophote::cli
