// What `isophote envelope` found, as files.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "envelope/sweep.hpp"

namespace isophote::cli {

struct MeasuredSweep {
  envelope::Sweep sweep;
  std::vector<envelope::Point> points; ///< of its values, in their order
};

struct EnvelopeContext {
  std::string command;
  std::string device;
  std::string driver;
  double seconds = 0;
  bool interrupted = false;
};

[[nodiscard]] nlohmann::ordered_json envelopeJson(const std::vector<MeasuredSweep>& sweeps,
                                                  const EnvelopeContext& context);
/// The sweeps of `all` that an earlier run's JSON holds, with its points; none where it is not such a file.
[[nodiscard]] std::vector<MeasuredSweep> measuredBefore(const std::string& json,
                                                        const std::vector<envelope::Sweep>& all);
/// One line a point.
[[nodiscard]] std::string envelopeCsv(const std::vector<MeasuredSweep>& sweeps);
/// A table of ranges, and the curves.
[[nodiscard]] std::string envelopePage(const std::vector<MeasuredSweep>& sweeps, const EnvelopeContext& context);
/// The curve of one sweep, an SVG file.
[[nodiscard]] std::string envelopeCurve(const MeasuredSweep& measured);

} // namespace isophote::cli
