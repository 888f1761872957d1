// Distributions and hypothesis tests, in double. Every statistical test of the project rests on these; they are tested
// in tests/unit/statistics_test.cpp against known values, and for seeing a planted 1% bias.
#pragma once

#include <cstdint>
#include <span>

namespace isophote::test {

/// Regularised incomplete gamma function Q(a, x) = Gamma(a, x) / Gamma(a), a > 0, x >= 0.
[[nodiscard]] double incompleteGammaQ(double a, double x);

/// Regularised incomplete beta function I_x(a, b), a, b > 0, x in [0, 1].
[[nodiscard]] double incompleteBeta(double a, double b, double x);

/// P(X >= x) of the chi-square distribution.
[[nodiscard]] double chiSquareSurvival(double x, double degreesOfFreedom);

/// P(|T| >= |t|) of Student's distribution.
[[nodiscard]] double studentTwoSided(double t, double degreesOfFreedom);

/// P(|Z| >= |z|) of the standard normal distribution.
[[nodiscard]] double normalTwoSided(double z);

/// The z with normalTwoSided(z) = p, 0 < p <= 1.
[[nodiscard]] double normalTwoSidedQuantile(double p);

/// The t with studentTwoSided(t) = p, 0 < p <= 1.
[[nodiscard]] double studentTwoSidedQuantile(double p, double degreesOfFreedom);

/// Per-test significance that gives `tests` independent tests the family-wise significance `alpha` (Sidak 1967).
[[nodiscard]] double sidak(double alpha, uint64_t tests);

/// Mean and variance in one pass (Welford 1962).
class Moments {
public:
  void add(double value);
  [[nodiscard]] uint64_t count() const { return count_; }
  [[nodiscard]] double mean() const { return mean_; }
  [[nodiscard]] double variance() const; ///< of one value, unbiased; 0 below two values
  [[nodiscard]] double standardError() const;

private:
  uint64_t count_ = 0;
  double mean_ = 0;
  double squares_ = 0;
};

/// Two-sided p-value of the t-test that the values' expectation is `expected`. Equal values: 1 where they match
/// `expected` to 1e-12 relative, else 0.
[[nodiscard]] double meanTest(const Moments& values, double expected);

/// Two-sided p-value that two sets of values share their expectation (Welch 1947).
[[nodiscard]] double welchTest(const Moments& a, const Moments& b);

struct ChiSquareResult {
  double statistic = 0;
  double degreesOfFreedom = 0;
  double p = 1;
  uint64_t pooledBins = 0; ///< bins that had too small an expectation to stand alone
  double stray = 0;        ///< share of the counts that fell where nothing was expected
};

/// Chi-square test of counts against expected counts (same total to rounding). Bins are pooled from the smallest
/// expectation upward until each pool expects at least `minimumExpected`. Counts in bins of expectation 0 above a share
/// of 1e-5 (rounding across a bin's edge) reject: p = 0.
[[nodiscard]] ChiSquareResult chiSquareTest(std::span<const uint64_t> observed, std::span<const double> expected,
                                            double minimumExpected = 5);

/// Two-sided p-value that two equally long sequences are uncorrelated (Fisher's z transform).
[[nodiscard]] double correlationTest(std::span<const double> a, std::span<const double> b);

} // namespace isophote::test
