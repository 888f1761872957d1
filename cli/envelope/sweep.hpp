// One quantity on its way to an extreme.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "envelope/measure.hpp"

namespace isophote::envelope {

/// A quantity, the values it takes, and the scene with a known image that each of them makes.
struct Sweep {
  std::string name;           ///< of the command line and of files
  std::string quantity;       ///< of the axis, with its unit
  std::string scene;          ///< what is rendered and where the answer comes from, one sentence
  std::vector<double> values; ///< in order
  double tame = 0;            ///< one of them at which nothing is extreme
  std::function<Case(double value)> at;
  /// In place of rendering `at`: for what is no render.
  std::function<Point(const Device& device, double value)> measured = {};
  std::vector<double> slow = {}; ///< values that take long whatever the effort
};

// One function a file; each adds its sweeps.
void addPlacementSweeps(std::vector<Sweep>& sweeps);
void addRoughnessSweeps(std::vector<Sweep>& sweeps);
void addRefractionSweeps(std::vector<Sweep>& sweeps);
void addLightSweeps(std::vector<Sweep>& sweeps);
void addSeriesSweeps(std::vector<Sweep>& sweeps);
void addMediumSweeps(std::vector<Sweep>& sweeps);
void addTriangleSweeps(std::vector<Sweep>& sweeps);
void addImageSweeps(std::vector<Sweep>& sweeps);

/// All of them, in the order of the pages.
[[nodiscard]] std::vector<Sweep> allSweeps();

/// Where the error stays below `limit` beyond doubt: the values around the tame one without a gap.
/// @param points  of the sweep, in its order
struct Range {
  bool any = false;
  double first = 0, last = 0;
  bool fromStart = false, toEnd = false; ///< nothing beyond was found wanting: the sweep ends there
};
[[nodiscard]] Range rangeBelow(const Sweep& sweep, const std::vector<Point>& points, double limit);

} // namespace isophote::envelope
