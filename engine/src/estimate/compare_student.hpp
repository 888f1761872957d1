// Tail probabilities of Student's t distribution.
#pragma once

namespace isophote::estimate {

/// P(|T| >= |t|) for `dof` degrees of freedom.
///
/// The regularized incomplete beta function I_x(dof/2, 1/2), x = dof / (dof + t^2), by its continued fraction (NIST
/// DLMF 8.17.22). @param dof  > 0, not necessarily whole; infinity gives the normal distribution Accuracy: relative
/// 1e-10 down to 1e-300, measured in tests/unit/compare_student_test.cpp.
[[nodiscard]] double studentTwoSided(double t, double dof);

/// The t with studentTwoSided(t, dof) = p. @param p  in (0, 1]
[[nodiscard]] double studentQuantile(double p, double dof);

/// The z with P(|Z| >= z) = p of the standard normal distribution; of p below 1e-300 that of 1e-300.
[[nodiscard]] double normalDeviation(double p);

} // namespace isophote::estimate
