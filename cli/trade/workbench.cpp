#include "trade/workbench.hpp"

#include <chrono>
#include <utility>

namespace isophote::cli {

Workbench::Workbench(const Device& device, Scene scene, const View& view, std::function<bool()> goOn)
    : device_(device), scene_(std::move(scene)), view_(view), goOn_(std::move(goOn)) {}

const GpuScene& Workbench::gpuScene(BvhBuild build) {
  return gpuScenes_.try_emplace(build, device_, scene_, Backend::Compute, build).first->second;
}

PathTracer& Workbench::tracer(const Settings& settings) {
  const std::string key =
      settingsJson(settings, SettingKind::Estimator).dump() + settingsJson(settings, SettingKind::Execution).dump();
  std::unique_ptr<PathTracer>& entry = tracers_[key];
  if (!entry) {
    ExecutionSettings execution = settings.execution;
    if (execution.pipeline == Pipeline::Auto)
      execution.pipeline = Pipeline::Wavefront; // a race would disturb the times
    try {
      entry = std::make_unique<PathTracer>(device_, gpuScene(settings.scene.bvhBuild), settings.estimator, execution);
    } catch (...) {
      tracers_.erase(key);
      throw;
    }
  }
  return *entry;
}

Film Workbench::makeFilm(bool aovs) const {
  return {device_, {.width = view_.width, .height = view_.height, .aovs = aovs}};
}

bool Workbench::renderMore(const Settings& settings, uint64_t seed, SampleRange samples, Film& film) {
  PathTracer& path = tracer(settings);
  path.setSeed(seed);
  return path.render(view_.camera, film, samples, [&](const Progress&) { return goOn_(); }) && goOn_();
}

std::optional<BenchRender> Workbench::render(const Settings& settings, uint64_t seed, SampleRange samples) {
  const double before = tracer(settings).statistics().renderSeconds;
  const bool denoise = settings.layers.denoiser != Denoiser::None;
  Film film = makeFilm(denoise);
  if (!renderMore(settings, seed, samples, film)) return std::nullopt;
  BenchRender result{
      .image = film.resolve(), .error = film.error(), .seconds = tracer(settings).statistics().renderSeconds - before};
  if (denoise) {
    const auto start = std::chrono::steady_clock::now();
    addDenoised(result.image);
    result.image = denoisedImage(result.image);
    result.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  return result;
}

double Workbench::compileSeconds() const {
  double seconds = 0;
  for (const auto& [key, path] : tracers_) seconds += path->statistics().compileSeconds;
  return seconds;
}

} // namespace isophote::cli
