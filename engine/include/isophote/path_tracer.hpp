// The path tracer.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "isophote/film.hpp"
#include "isophote/gpu_scene.hpp"
#include "isophote/settings.hpp"

namespace isophote {

/// Counters of things that must not happen; all zero in a healthy render.
struct StatusCounters {
  uint64_t queueOverflow = 0;
  uint64_t stackOverflow = 0;
  uint64_t nonFinite = 0;      ///< samples dropped because a value was NaN or infinite
  uint64_t negative = 0;       ///< samples dropped because a value was negative
  uint64_t clipped = 0;        ///< sample values beyond the Film's range, stored at its limit
  uint64_t outOfBounds = 0;    ///< indices refused in checked builds
  uint64_t mediumOverflow = 0; ///< volumes entered inside more others than a path remembers; they were ignored
  [[nodiscard]] uint64_t total() const {
    return queueOverflow + stackOverflow + nonFinite + negative + clipped + outOfBounds + mediumOverflow;
  }
};

struct KernelStatistics {
  std::string name;
  uint64_t dispatches = 0;
  double milliseconds = 0;
  double longestMilliseconds = 0;
  double compileMilliseconds = 0;
  uint32_t spirvBytes = 0;
};

/// What one pipeline has done.
struct PipelineStatistics {
  uint64_t submits = 0;
  uint64_t rays = 0;
  double milliseconds = 0;              ///< on the device
  uint32_t pathsInFlight = 0;           ///< at most, in the next submit
  bool pathsInFlightAreSettled = false; ///< asked for, or found best, now or in an earlier run
};

struct RenderStatistics {
  uint64_t primaryRays = 0;
  uint64_t bounceRays = 0;
  uint64_t shadowRays = 0;
  double renderSeconds = 0; ///< wall clock inside render/advance
  double compileSeconds = 0;
  double firstPixelSeconds = 0; ///< from the PathTracer's construction to the end of the first submit
  uint64_t queueBytes = 0;
  uint64_t bytesPerPath = 0;
  uint32_t pathPoolSize = 0; ///< room for so many paths
  uint32_t workgroupSize = 0;
  Pipeline pipeline = Pipeline::Wavefront; ///< that the next submit uses, Wavefront or Fused
  bool pipelineIsSettled = false;          ///< asked for, or found faster
  PipelineStatistics wavefront;
  PipelineStatistics fused;
  std::vector<KernelStatistics> kernels; ///< those that exist
  std::vector<BufferUse> buffers;
  bool textureBinding = false;          ///< some kernel declares the texture array
  std::vector<std::string> cameraMedia; ///< materials of the volumes that the last camera was in, the outermost first
  StatusCounters status;
};

struct Progress {
  double fraction = 0; ///< of this call's samples
  double seconds = 0;
  uint64_t rays = 0;
};

/// Renders one scene. Borrows Device and GpuScene; borrows a Film while rendering.
class PathTracer {
public:
  PathTracer(const Device& device, const GpuScene& scene, const EstimatorSettings& estimator = {},
             const ExecutionSettings& execution = {});
  PathTracer(PathTracer&&) noexcept;
  PathTracer& operator=(PathTracer&&) noexcept;
  ~PathTracer();

  /// Renders that begin from now on use this seed; the kernels stay.
  void setSeed(uint64_t seed);

  /// Renders that begin from now on sample these pixels only: indices into the film's crop, row by row, each once.
  /// None: all.
  void setPixels(std::span<const uint32_t> pixels);

  /// Adds samples `range` of every pixel of the film. `onProgress` is called after each submit; when it returns false
  /// no new sample starts, those in flight finish, and render returns false with a valid film.
  bool render(const Camera& camera, Film& film, SampleRange range,
              const std::function<bool(const Progress&)>& onProgress = {});

  /// The same in steps, for a viewer: begin, then advance until it returns false. `cancel` drops the samples in flight
  /// (clear the film before the next begin).
  void begin(const Camera& camera, Film& film, SampleRange range);
  bool advance();
  void finish(); ///< starts no new sample and completes those in flight
  void cancel();

  /// What is left of the last render's samples: none where it was completed. Rendering this range adds exactly the
  /// samples that are missing. Of renders that ended otherwise than by cancel.
  [[nodiscard]] SampleRange left() const;

  [[nodiscard]] RenderStatistics statistics() const;
  /// The features the kernels were specialised for.
  [[nodiscard]] FeatureSet features() const;

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace isophote
