#include "isophote/interval.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include "estimate/compare_student.hpp"

namespace isophote {

Interval meanInterval(std::span<const double> values, double confidence) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const auto count = static_cast<double>(values.size());
  double sum = 0;
  for (const double value : values) sum += value;
  if (values.empty()) return {0, -kInfinity, kInfinity};
  const double mean = sum / count;
  if (values.size() < 2) return {mean, -kInfinity, kInfinity};
  double squares = 0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  const double error = std::sqrt(squares / (count - 1) / count);
  const double half = error > 0 ? estimate::studentQuantile(1 - confidence, count - 1) * error : 0;
  return {mean, mean - half, mean + half};
}

Interval ratioInterval(std::span<const double> a, std::span<const double> b, double confidence) {
  std::vector<double> logs;
  for (size_t i = 0; i < a.size() && i < b.size(); ++i) logs.push_back(std::log(a[i] / b[i]));
  const Interval interval = meanInterval(logs, confidence);
  return {std::exp(interval.value), std::exp(interval.lower), std::exp(interval.upper)};
}

} // namespace isophote
