// Rays that submits traced in a millisecond, for choices that are made by measurement.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace isophote {

class SubmitSpeeds {
public:
  void add(uint64_t rays, double milliseconds) {
    // A device may measure no time.
    raysPerMillisecond_.push_back(static_cast<double>(rays) / std::max(milliseconds, 1e-3));
  }
  [[nodiscard]] size_t count() const { return raysPerMillisecond_.size(); }
  /// Some submits waited for another program: their mean would tell of that. One at least must have been added.
  [[nodiscard]] double median() const {
    std::vector<double> values = raysPerMillisecond_;
    const auto middle = values.begin() + static_cast<ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
  }

private:
  std::vector<double> raysPerMillisecond_;
};

} // namespace isophote
