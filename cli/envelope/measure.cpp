#include "envelope/measure.hpp"

#include <algorithm>
#include <chrono>
#include <optional>
#include <vector>

#include "isophote/error.hpp"
#include "isophote/interval.hpp"
#include "isophote/path_tracer.hpp"

namespace isophote::envelope {
namespace {

/// The mean of green and its 95% interval. Pixels are independent; where one has no error bar of its own (fewer than
/// two replicates hold samples) the pixels, all of one expectation, are each other's.
Interval meanOf(const Image& image) {
  const std::vector<float>& values = image.find("G")->values;
  const std::vector<float>& halfWidths = image.find("ci95.G")->values;
  double sum = 0, squares = 0;
  for (size_t i = 0; i < values.size(); ++i) {
    sum += static_cast<double>(values[i]);
    squares += static_cast<double>(halfWidths[i]) * static_cast<double>(halfWidths[i]);
  }
  if (!std::isfinite(squares)) {
    const std::vector<double> all(values.begin(), values.end());
    return meanInterval(all);
  }
  const auto count = static_cast<double>(values.size());
  const double half = std::sqrt(squares) / count;
  return {.value = sum / count, .lower = sum / count - half, .upper = sum / count + half};
}

bool goodEnough(const Point& point, const Effort& effort) {
  if (point.halfWidth == 0 && std::abs(point.error) > 0.01) return false; // what makes the difference may be rare
  return point.halfWidth <= std::max(effort.halfWidth, std::abs(point.error) / 5);
}

void render(const Device& device, const Case& c, const Effort& effort, Point& point) {
  const GpuScene scene(device, c.scene);
  Film film(device, {.width = c.width, .height = c.height, .crop = c.crop, .aovs = false});
  PathTracer tracer(device, scene, c.estimator);
  const uint32_t most = std::max(c.mostSamples / effort.divideBy, c.fewestSamples);
  const double scale = c.scale > 0 ? c.scale : c.exact;
  for (uint32_t done = 0, next = c.fewestSamples; done < most; next = std::min(4 * next, most)) {
    const bool finished = tracer.render(c.camera, film, {done, next}, [&](const Progress&) { return effort.goOn(); });
    if (!finished || !effort.goOn()) {
      point.failure = "interrupted";
      return;
    }
    done = next;
    const Interval mean = meanOf(film.resolve());
    point.samples = done;
    point.error = (mean.value - c.exact) / scale;
    point.halfWidth = (mean.upper - mean.lower) / 2 / scale;
    if (goodEnough(point, effort)) break;
  }
  const uint64_t dropped = tracer.statistics().status.total();
  if (dropped > 0) point.failure = std::to_string(dropped) + " samples were dropped or changed";
}

} // namespace

Point measure(const Device& device, const Case& c, double value, const Effort& effort) {
  const auto start = std::chrono::steady_clock::now();
  Point point{.value = value};
  try {
    render(device, c, effort, point);
  } catch (const Error& error) {
    point.failure = error.what();
  }
  point.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return point;
}

} // namespace isophote::envelope
