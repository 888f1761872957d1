// Formulas as the course writes them, evaluated against what they should give. None of them is in the renderer.
#pragma once

#include <string>
#include <vector>

namespace isophote::cli {

struct CourseFormula {
  std::string what;      ///< and what is computed of it
  std::string asWritten; ///< formula
  std::string correct;
  double found = 0;    ///< as written
  double expected = 0; ///< correct
};

/// Each by quadrature in double precision.
[[nodiscard]] std::vector<CourseFormula> courseFormulas();

} // namespace isophote::cli
