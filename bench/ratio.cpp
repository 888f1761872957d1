#include "ratio.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace isophote::bench {
namespace {

constexpr size_t kResamples = 2000;

} // namespace

double median(std::span<const double> values) {
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  const size_t half = sorted.size() / 2;
  return sorted.size() % 2 == 1 ? sorted[half] : 0.5 * (sorted[half - 1] + sorted[half]);
}

Ratio pairedRatio(std::span<const double> slow, std::span<const double> fast) {
  std::vector<double> logs;
  for (size_t i = 0; i < slow.size(); ++i) logs.push_back(std::log(slow[i] / fast[i]));
  std::mt19937_64 random(1);
  std::uniform_int_distribution<size_t> pick(0, logs.size() - 1);
  std::vector<double> medians, resampled(logs.size());
  for (size_t k = 0; k < kResamples; ++k) {
    for (double& value : resampled) value = logs[pick(random)];
    medians.push_back(median(resampled));
  }
  std::sort(medians.begin(), medians.end());
  return {std::exp(median(logs)), std::exp(medians[kResamples / 40]), std::exp(medians[kResamples - kResamples / 40])};
}

} // namespace isophote::bench
