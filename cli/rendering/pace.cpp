#include "rendering/pace.hpp"

#include <algorithm>
#include <cmath>

namespace isophote::cli {
namespace {

// Half-width of the logarithm where there is one pass to go by, and the least there is: machines are not that steady.
constexpr double kUnknown = 0.41;
constexpr double kLeast = 0.05;

} // namespace

void Pace::add(double samples, double seconds) {
  if (!(samples > 0 && seconds > 0)) return;
  passes_.push_back({samples, seconds});
  samples_ += samples;
}

Interval Pace::secondsPerSample() const {
  double samples = 0;
  double seconds = 0;
  std::vector<double> logarithms;
  for (auto pass = passes_.rbegin(); pass != passes_.rend() && samples < samples_ / 2; ++pass) {
    samples += pass->samples;
    seconds += pass->seconds;
    logarithms.push_back(std::log(pass->seconds / pass->samples));
  }
  if (!(samples > 0)) return {};
  double half = kUnknown;
  if (logarithms.size() >= 2) {
    const Interval mean = meanInterval(logarithms);
    half = std::clamp((mean.upper - mean.lower) / 2, kLeast, kUnknown);
  }
  const double value = seconds / samples;
  return {.value = value, .lower = value * std::exp(-half), .upper = value * std::exp(half)};
}

Interval product(const Interval& a, const Interval& b) {
  const auto half = [](double one, double other) { return std::exp(std::hypot(std::log(one), std::log(other))); };
  const double value = a.value * b.value;
  if (!(value > 0)) return {};
  return {.value = value,
          .lower = value / half(a.value / a.lower, b.value / b.lower),
          .upper = value * half(a.upper / a.value, b.upper / b.value)};
}

} // namespace isophote::cli
