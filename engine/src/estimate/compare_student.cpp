#include "estimate/compare_student.hpp"

#include <cmath>

namespace isophote::estimate {
namespace {

/// I_x(a, b) for x < (a + 1) / (a + b + 2), where the fraction converges fast (modified Lentz).
double incompleteBeta(double x, double a, double b) {
  constexpr double kTiny = 1e-300;
  constexpr int kMaxTerms = 500; // needed: order of sqrt(max(a, b)), below 100 for dof up to 1e4
  double c = 1;
  double d = 1 - (a + b) * x / (a + 1);
  d = 1 / (std::abs(d) < kTiny ? kTiny : d);
  double fraction = d;
  for (int m = 1; m <= kMaxTerms; ++m) {
    const auto step = [&](double coefficient) {
      d = 1 + coefficient * d;
      d = 1 / (std::abs(d) < kTiny ? kTiny : d);
      c = 1 + coefficient / c;
      if (std::abs(c) < kTiny) c = kTiny;
      fraction *= c * d;
    };
    step(m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m)));
    step(-(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1)));
    if (std::abs(c * d - 1) < 1e-14) break;
  }
  const double logFactor = std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x);
  return std::exp(logFactor) * fraction / a;
}

} // namespace

double studentTwoSided(double t, double dof) {
  t = std::abs(t);
  if (std::isinf(t)) return 0;
  // Beyond 1e6 degrees of freedom the normal distribution differs by less than 1e-6 t^4 relative.
  if (dof > 1e6) return std::erfc(t / std::sqrt(2.0));
  if (t == 0) return 1;
  const double a = dof / 2;
  const double b = 0.5;
  const double x = dof / (dof + t * t);
  if (x < (a + 1) / (a + b + 2)) return incompleteBeta(x, a, b);
  return 1 - incompleteBeta(t * t / (dof + t * t), b, a);
}

} // namespace isophote::estimate
