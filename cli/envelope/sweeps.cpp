#include <algorithm>

#include "envelope/sweep.hpp"

namespace isophote::envelope {

std::vector<Sweep> allSweeps() {
  std::vector<Sweep> sweeps;
  addPlacementSweeps(sweeps);
  addRoughnessSweeps(sweeps);
  addRefractionSweeps(sweeps);
  addLightSweeps(sweeps);
  addSeriesSweeps(sweeps);
  addMediumSweeps(sweeps);
  addTriangleSweeps(sweeps);
  addImageSweeps(sweeps);
  return sweeps;
}

Range rangeBelow(const Sweep& sweep, const std::vector<Point>& points, double limit) {
  const auto tame = std::find_if(points.begin(), points.end(), [&](const Point& p) { return p.value == sweep.tame; });
  if (tame == points.end() || tame->bound() > limit) return {};
  auto first = tame, last = tame;
  while (first != points.begin() && (first - 1)->bound() <= limit) --first;
  while (last + 1 != points.end() && (last + 1)->bound() <= limit) ++last;
  return {.any = true,
          .first = first->value,
          .last = last->value,
          .fromStart = first->value == sweep.values.front(),
          .toEnd = last->value == sweep.values.back()};
}

} // namespace isophote::envelope
