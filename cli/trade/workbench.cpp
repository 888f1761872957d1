#include "trade/workbench.hpp"

#include <utility>

namespace isophote::cli {

Workbench::Workbench(const Device& device, const Scene& scene, const View& view, std::function<bool()> goOn)
    : device_(device), scene_(device, scene), view_(view), goOn_(std::move(goOn)) {}

PathTracer& Workbench::tracer(const Settings& settings) {
  const std::string key = settingsJson(settings, false).dump() + settingsJson(settings, true).dump();
  std::unique_ptr<PathTracer>& entry = tracers_[key];
  if (!entry) {
    try {
      entry = std::make_unique<PathTracer>(device_, scene_, settings.estimator, settings.execution);
    } catch (...) {
      tracers_.erase(key);
      throw;
    }
  }
  return *entry;
}

Film Workbench::makeFilm() const { return {device_, {.width = view_.width, .height = view_.height, .aovs = false}}; }

bool Workbench::renderMore(const Settings& settings, uint64_t seed, SampleRange samples, Film& film) {
  PathTracer& path = tracer(settings);
  path.setSeed(seed);
  return path.render(view_.camera, film, samples, [&](const Progress&) { return goOn_(); }) && goOn_();
}

std::optional<BenchRender> Workbench::render(const Settings& settings, uint64_t seed, SampleRange samples) {
  const double before = tracer(settings).statistics().renderSeconds;
  Film film = makeFilm();
  if (!renderMore(settings, seed, samples, film)) return std::nullopt;
  return BenchRender{
      .image = film.resolve(), .error = film.error(), .seconds = tracer(settings).statistics().renderSeconds - before};
}

double Workbench::compileSeconds() const {
  double seconds = 0;
  for (const auto& [key, path] : tracers_) seconds += path->statistics().compileSeconds;
  return seconds;
}

} // namespace isophote::cli
