#include "estimate/compare_student.hpp"

#include <algorithm>
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

double studentQuantile(double p, double dof) {
  double low = 0;
  double high = 1;
  while (studentTwoSided(high, dof) > p) high *= 2;
  for (int i = 0; i < 100 && high - low > 1e-13 * high; ++i) {
    const double middle = (low + high) / 2;
    (studentTwoSided(middle, dof) > p ? low : high) = middle;
  }
  return (low + high) / 2;
}

double normalDeviation(double p) {
  if (!(p < 1)) return 0;
  const double logP = std::log(std::max(p, 1e-300));
  // Newton's iteration on log erfc(z / sqrt 2) = log p, which is concave; erfc(z / sqrt 2) <= exp(-z^2 / 2), so that it
  // begins beyond the root and comes down to it.
  double z = std::sqrt(-2 * logP);
  for (int i = 0; i < 50; ++i) {
    const double tail = std::erfc(z / std::sqrt(2.0));
    const double step = (std::log(tail) - logP) * tail / (std::sqrt(2 / M_PI) * std::exp(-0.5 * z * z));
    z += step;
    if (std::abs(step) < 1e-12 * (1 + z)) break;
  }
  return z;
}

} // namespace isophote::estimate
