#include "upload/alias_table.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

namespace isophote {

namespace {

/// weights / sum, as the device will see them: shares that float cannot hold as normal numbers count as zero.
std::vector<double> shares(std::span<const double> weights) {
  std::vector<double> result(weights.begin(), weights.end());
  const double largest = result.empty() ? 0 : *std::max_element(result.begin(), result.end());
  if (!(largest > 0)) return {};
  for (double& share : result) share /= largest; // the sum of large weights could overflow
  const double sum = std::accumulate(result.begin(), result.end(), 0.0);
  for (double& share : result) {
    share /= sum;
    if (share < static_cast<double>(std::numeric_limits<float>::min())) share = 0;
  }
  return result;
}

} // namespace

std::vector<gpu::AliasEntry> buildAliasTable(std::span<const double> weights) {
  const std::vector<double> share = shares(weights);
  const size_t count = share.size();
  std::vector<gpu::AliasEntry> table(count);
  std::vector<double> height(count); // of each bin's own share, in units of a full bin
  std::vector<uint32_t> small;
  std::vector<uint32_t> large;
  for (size_t i = 0; i < count; ++i) {
    const auto index = static_cast<uint32_t>(i);
    height[i] = share[i] * static_cast<double>(count);
    table[i] = {1.0f, index, static_cast<float>(share[i])};
    (height[i] < 1 ? small : large).push_back(index);
  }
  while (!small.empty() && !large.empty()) {
    const uint32_t low = small.back();
    const uint32_t high = large.back();
    small.pop_back();
    table[low].threshold = static_cast<float>(height[low]);
    table[low].alias = high;
    height[high] -= 1 - height[low];
    if (height[high] < 1) {
      large.pop_back();
      small.push_back(high);
    }
  }
  // Bins and shares left over are equal in number, so what is left over is full to rounding (never a zero share) and
  // keeps threshold 1.
  return table;
}

} // namespace isophote
