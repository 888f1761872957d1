#include "isophote/trade_off.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace isophote {

double errorAfter(const TradeOff& way, double seconds) { return std::sqrt(way.cost / seconds + way.biasSquare); }

double secondsToError(const TradeOff& way, double error) {
  const double left = error * error - way.biasSquare;
  return left > 0 ? way.cost / left : std::numeric_limits<double>::infinity();
}

std::vector<size_t> paretoFront(std::span<const TradeOff> ways) {
  std::vector<size_t> order(ways.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) {
    return ways[a].cost != ways[b].cost ? ways[a].cost < ways[b].cost : ways[a].biasSquare < ways[b].biasSquare;
  });
  std::vector<size_t> front;
  double leastBias = std::numeric_limits<double>::infinity();
  for (const size_t way : order) {
    if (ways[way].biasSquare >= leastBias) continue;
    leastBias = ways[way].biasSquare;
    front.push_back(way);
  }
  return front;
}

} // namespace isophote
