#include "support/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace isophote::test {

namespace {

constexpr int kMaxTerms = 100000; // the series need about sqrt(a) terms; a is half the number of bins
constexpr double kTiny = 1e-300;

/// Lower incomplete gamma P by its series, for x < a + 1 (Abramowitz and Stegun 1964, 6.5.29).
double gammaSeriesP(double a, double x) {
  double term = 1 / a;
  double sum = term;
  for (int n = 1; n < kMaxTerms && std::abs(term) > 1e-17 * std::abs(sum); ++n) {
    term *= x / (a + n);
    sum += term;
  }
  return sum * std::exp(a * std::log(x) - x - std::lgamma(a));
}

/// Evaluates b0 + a1 / (b1 + a2 / (b2 + ...)) by the modified Lentz algorithm (Thompson and Barnett 1986).
template <class Coefficients> double continuedFraction(double b0, Coefficients coefficients) {
  double f = b0 == 0 ? kTiny : b0;
  double c = f;
  double d = 0;
  for (int n = 1; n < kMaxTerms; ++n) {
    const auto [a, b] = coefficients(n);
    d = b + a * d;
    c = b + a / c;
    if (std::abs(d) < kTiny) d = kTiny;
    if (std::abs(c) < kTiny) c = kTiny;
    d = 1 / d;
    f *= c * d;
    if (std::abs(c * d - 1) < 1e-16) break;
  }
  return f;
}

/// Upper incomplete gamma Q by its continued fraction, for x >= a + 1 (Abramowitz and Stegun 1964, 6.5.31).
double gammaFractionQ(double a, double x) {
  const double fraction = continuedFraction(x + 1 - a, [&](int n) {
    return std::pair{n * (a - n), x + 2.0 * n + 1 - a};
  });
  return std::exp(a * std::log(x) - x - std::lgamma(a)) / fraction;
}

/// Abramowitz and Stegun 1964, 26.5.8.
double betaFraction(double a, double b, double x) {
  const double fraction = continuedFraction(1, [&](int n) {
    const double m = n / 2;
    const double d = n % 2 == 0 ? m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m))
                                : -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    return std::pair{d, 1.0};
  });
  const double logFactor = std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x);
  return std::exp(logFactor) / (a * fraction);
}

/// The x >= 0 where the decreasing `survival` reaches p.
template <class Survival> double invert(double p, Survival survival) {
  if (!(p > 0 && p <= 1)) throw std::invalid_argument("a probability in (0, 1] is needed");
  double high = 1;
  while (survival(high) > p && high < 1e300) high *= 2;
  double low = 0;
  for (int step = 0; step < 200 && high - low > 1e-15 * high; ++step) {
    const double middle = 0.5 * (low + high);
    (survival(middle) > p ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

} // namespace

double incompleteGammaQ(double a, double x) {
  if (x <= 0) return 1;
  return x < a + 1 ? 1 - gammaSeriesP(a, x) : gammaFractionQ(a, x);
}

double incompleteBeta(double a, double b, double x) {
  if (x <= 0) return 0;
  if (x >= 1) return 1;
  return x < (a + 1) / (a + b + 2) ? betaFraction(a, b, x) : 1 - betaFraction(b, a, 1 - x);
}

double chiSquareSurvival(double x, double degreesOfFreedom) {
  return incompleteGammaQ(0.5 * degreesOfFreedom, 0.5 * x);
}

double studentTwoSided(double t, double degreesOfFreedom) {
  return incompleteBeta(0.5 * degreesOfFreedom, 0.5, degreesOfFreedom / (degreesOfFreedom + t * t));
}

double normalTwoSided(double z) { return std::erfc(std::abs(z) / std::numbers::sqrt2); }

double normalTwoSidedQuantile(double p) { return invert(p, normalTwoSided); }

double studentTwoSidedQuantile(double p, double degreesOfFreedom) {
  return invert(p, [&](double t) { return studentTwoSided(t, degreesOfFreedom); });
}

double sidak(double alpha, uint64_t tests) { return -std::expm1(std::log1p(-alpha) / static_cast<double>(tests)); }

void Moments::add(double value) {
  ++count_;
  const double delta = value - mean_;
  mean_ += delta / static_cast<double>(count_);
  squares_ += delta * (value - mean_);
}

double Moments::variance() const { return count_ < 2 ? 0 : squares_ / static_cast<double>(count_ - 1); }

double Moments::standardError() const { return count_ == 0 ? 0 : std::sqrt(variance() / static_cast<double>(count_)); }

double meanTest(const Moments& values, double expected) {
  if (values.count() < 2) throw std::invalid_argument("a t-test needs two values");
  const double difference = values.mean() - expected;
  if (!std::isfinite(difference)) return 0;
  if (values.variance() == 0) return std::abs(difference) <= 1e-12 * std::abs(expected) ? 1 : 0;
  return studentTwoSided(difference / values.standardError(), static_cast<double>(values.count() - 1));
}

double welchTest(const Moments& a, const Moments& b) {
  if (a.count() < 2 || b.count() < 2) throw std::invalid_argument("a t-test needs two values on each side");
  const double va = a.variance() / static_cast<double>(a.count());
  const double vb = b.variance() / static_cast<double>(b.count());
  const double difference = a.mean() - b.mean();
  if (!std::isfinite(difference)) return 0;
  if (va + vb == 0) return std::abs(difference) <= 1e-12 * std::abs(a.mean()) ? 1 : 0;
  const double degrees = (va + vb) * (va + vb) /
                         (va * va / static_cast<double>(a.count() - 1) + vb * vb / static_cast<double>(b.count() - 1));
  return studentTwoSided(difference / std::sqrt(va + vb), degrees);
}

ChiSquareResult chiSquareTest(std::span<const uint64_t> observed, std::span<const double> expected,
                              double minimumExpected) {
  if (observed.size() != expected.size()) throw std::invalid_argument("as many expectations as counts are needed");
  std::vector<size_t> order(observed.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return expected[a] < expected[b]; });

  ChiSquareResult result;
  const double total = std::accumulate(observed.begin(), observed.end(), 0.0);
  double pools = 0;
  double pooledObserved = 0;
  double pooledExpected = 0;
  double strayCount = 0;
  for (size_t k = 0; k < order.size(); ++k) {
    const size_t bin = order[k];
    if (expected[bin] <= 0) {
      strayCount += static_cast<double>(observed[bin]);
      continue;
    }
    pooledObserved += static_cast<double>(observed[bin]);
    pooledExpected += expected[bin];
    if (expected[bin] < minimumExpected) ++result.pooledBins;
    if (pooledExpected < minimumExpected && k + 1 < order.size()) continue;
    result.statistic += (pooledObserved - pooledExpected) * (pooledObserved - pooledExpected) / pooledExpected;
    ++pools;
    pooledObserved = pooledExpected = 0;
  }
  result.stray = total > 0 ? strayCount / total : 0;
  result.degreesOfFreedom = pools - 1;
  if (pools < 2) throw std::invalid_argument("a chi-square test needs two pools of bins");
  result.p = chiSquareSurvival(result.statistic, result.degreesOfFreedom);
  if (result.stray > 1e-5 || !std::isfinite(result.statistic)) result.p = 0;
  return result;
}

double correlationTest(std::span<const double> a, std::span<const double> b) {
  if (a.size() != b.size() || a.size() < 5) throw std::invalid_argument("two sequences of one length >= 5 are needed");
  const double n = static_cast<double>(a.size());
  const double meanA = std::accumulate(a.begin(), a.end(), 0.0) / n;
  const double meanB = std::accumulate(b.begin(), b.end(), 0.0) / n;
  double aa = 0;
  double bb = 0;
  double ab = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    aa += (a[i] - meanA) * (a[i] - meanA);
    bb += (b[i] - meanB) * (b[i] - meanB);
    ab += (a[i] - meanA) * (b[i] - meanB);
  }
  const double r = std::clamp(ab / std::sqrt(aa * bb), -1 + 1e-15, 1 - 1e-15);
  return normalTwoSided(std::atanh(r) * std::sqrt(n - 3));
}

} // namespace isophote::test
