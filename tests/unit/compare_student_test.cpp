#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "estimate/compare_student.hpp"

namespace isophote::estimate {
namespace {

void expectRelative(double actual, double expected, double tolerance, double t, double dof) {
  EXPECT_NEAR(actual / expected, 1, tolerance) << "t = " << t << ", dof = " << dof << ", p = " << expected;
}

// dof 1 is the Cauchy distribution; dof 2 has P = 1 - t / sqrt(2 + t^2) = 2 / ((2 + t^2) (1 + t / sqrt(2 + t^2))).
TEST(StudentTail, MatchesClosedFormsFarIntoTheTail) {
  for (double t = 1e-3; t < 1e12; t *= 3) {
    expectRelative(studentTwoSided(t, 1), 2 / std::numbers::pi * std::atan(1 / t), 1e-10, t, 1);
    const double s = 2 + t * t;
    expectRelative(studentTwoSided(t, 2), 2 / (s * (1 + t / std::sqrt(s))), 1e-10, t, 2);
    EXPECT_EQ(studentTwoSided(-t, 2), studentTwoSided(t, 2));
  }
}

/// Twice the density's integral from t to infinity, by Simpson's rule in log x up to where the integrand has lost
/// 1e-18.
double integratedTail(double t, double dof) {
  const double logNorm = std::lgamma((dof + 1) / 2) - std::lgamma(dof / 2) - 0.5 * std::log(dof * std::numbers::pi);
  const auto integrand = [&](double u) {
    const double x = std::exp(u);
    return x * std::exp(logNorm - (dof + 1) / 2 * std::log1p(x * x / dof));
  };
  constexpr int kSteps = 20000;
  const double lower = std::log(t);
  double length = 1e-4;
  while (integrand(lower + length) > 1e-18 * integrand(lower)) length *= 1.5;
  const double step = length / kSteps;
  double sum = 0;
  for (int i = 0; i <= kSteps; ++i)
    sum += (i == 0 || i == kSteps ? 1 : i % 2 == 1 ? 4 : 2) * integrand(lower + i * step);
  return 2 * sum * step / 3;
}

TEST(StudentTail, MatchesTheIntegratedDensityForFractionalDegrees) {
  for (const double dof : {1.0, 3.7, 7.0, 9.31, 14.0, 113.4, 224.0, 5000.0}) {
    for (const double t : {0.1, 1.0, 2.0, 5.0, 9.0, 30.0}) {
      const double expected = integratedTail(t, dof);
      if (expected > 1e-300) expectRelative(studentTwoSided(t, dof), expected, 1e-8, t, dof);
    }
  }
}

TEST(StudentTail, HasTheTablesQuantiles) {
  EXPECT_NEAR(studentTwoSided(2.364624, 7), 0.05, 1e-7);
  EXPECT_NEAR(studentTwoSided(1.959964, 1e9), 0.05, 1e-7);
  EXPECT_EQ(studentTwoSided(0, 7), 1);
  EXPECT_EQ(studentTwoSided(INFINITY, 7), 0);
}

TEST(StudentTail, QuantilesAreItsInverse) {
  for (const double p : {1.0, 0.5, 0.05, 1e-3, 1e-12}) {
    for (const double dof : {1.0, 7.0, 1e3}) EXPECT_NEAR(studentTwoSided(studentQuantile(p, dof), dof), p, 1e-9 * p);
  }
  EXPECT_NEAR(studentQuantile(0.05, 7), 2.364624, 1e-6);
}

TEST(StudentTail, NormalDeviationsAreTheInverseOfTheTail) {
  EXPECT_NEAR(normalDeviation(0.05), 1.959963985, 1e-9);
  for (const double p : {0.999, 0.5, 1e-3, 1e-20, 1e-250})
    EXPECT_NEAR(std::erfc(normalDeviation(p) / std::sqrt(2.0)), p, 1e-9 * p);
  EXPECT_EQ(normalDeviation(1), 0);
  EXPECT_EQ(normalDeviation(0), normalDeviation(1e-300));
}

} // namespace
} // namespace isophote::estimate
