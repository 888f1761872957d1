// Renders one scene with many settings, again and again.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "input/scene_source.hpp"
#include "isophote/path_tracer.hpp"
#include "setting_table.hpp"

namespace isophote::cli {

struct BenchRender {
  Image image;         ///< the denoised one, without error bars, where the settings name a denoiser
  ErrorEstimate error; ///< before the denoiser
  double seconds = 0;  ///< of rendering and denoising, without the compilation of kernels
};

/// Kernels are compiled once for each set of settings and kept.
class Workbench {
public:
  /// @param goOn  asked now and then; false ends the render under way, which then yields nothing
  Workbench(const Device& device, Scene scene, const View& view, std::function<bool()> goOn);

  /// @throws UsageError where the settings do not go together
  [[nodiscard]] std::optional<BenchRender> render(const Settings& settings, uint64_t seed, SampleRange samples);

  /// Adds samples to `film` until `until` says so; for the reference.
  /// @return false where `goOn` ended it
  bool renderMore(const Settings& settings, uint64_t seed, SampleRange samples, Film& film);

  /// @param aovs  what a denoiser needs
  [[nodiscard]] Film makeFilm(bool aovs = false) const;
  [[nodiscard]] const View& view() const { return view_; }
  [[nodiscard]] double compileSeconds() const;

private:
  [[nodiscard]] const GpuScene& gpuScene(BvhBuild build);
  [[nodiscard]] PathTracer& tracer(const Settings& settings);

  const Device& device_;
  Scene scene_;
  std::map<BvhBuild, GpuScene> gpuScenes_; // made when first asked for
  View view_;
  std::function<bool()> goOn_;
  std::map<std::string, std::unique_ptr<PathTracer>> tracers_;
};

} // namespace isophote::cli
