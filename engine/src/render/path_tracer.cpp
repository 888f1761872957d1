#include "isophote/path_tracer.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <optional>

#include "gpu/commands.hpp"
#include "isophote/error.hpp"
#include "render/camera_media.hpp"
#include "render/film_impl.hpp"
#include "render/path_pool.hpp"
#include "render/pipeline_choice.hpp"
#include "render/render_view.hpp"
#include "render/wavefront_kernels.hpp"
#include "shared/geometry_types.h"
#include "upload/filter_table.hpp"
#include "upload/gpu_scene.hpp"
#include "upload/scattering_tables.hpp"

namespace isophote {
namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

// llvmpipe keeps a pool of this size in its caches; a GPU needs enough paths to fill its lanes several times.
constexpr uint32_t kCpuPathPool = 1u << 15;
constexpr uint32_t kGpuPathPool = 1u << 20;
constexpr uint32_t kCpuWorkgroup = 64;
constexpr uint32_t kGpuWorkgroup = 128;
constexpr uint32_t kMaxWavesPerSubmit = 64;
constexpr uint32_t kDispatchesPerWave = 12;
constexpr uint32_t kMaxStepsPerDispatch = 1024;
// Watchdogs kill long dispatches, and Ctrl-C must be answered: above this the wave gets smaller.
constexpr double kLongestDispatchMilliseconds = 100;
constexpr uint32_t kFewestActivePaths = 256;

} // namespace

struct PathTracer::Impl {
  const Device& device;
  const GpuScene& scene;
  EstimatorSettings estimator;
  ExecutionSettings execution;
  uint32_t workgroupSize;
  Clock::time_point constructed = Clock::now();

  ScatteringTables tables;
  gpu::Buffer sceneView; ///< the scene's, with the tables
  /// One white texel, bound where an all-features kernel runs on a scene without textures.
  gpu::TextureArray placeholderTextures;
  std::optional<RenderKernels> kernels;
  FeatureSet kernelFeatures;
  KernelNeeds kernelNeeds;
  double compileMilliseconds = 0; ///< of the kernels that the render began with
  PipelineChoice choice;
  gpu::Buffer pixelList; ///< crop pixels to sample; null: all
  std::optional<PathPool> pool;
  gpu::CommandStream commands;

  Film* film = nullptr; ///< of the render under way
  SampleRange asked;    ///< of it
  SampleRange left;     ///< of the last one
  uint64_t workEnd = 0;
  uint32_t wavesPerSubmit = 1;
  uint32_t stepsPerDispatch = 1; ///< of the fused kernel
  uint32_t fullSteps = 1;        ///< the same, as it last was while new paths started
  uint32_t activeLimit = 0;
  bool accepting = true;   ///< new samples may start
  gpu::WaveState last{};   ///< at the end of the last submit
  RenderStatistics totals; ///< of finished renders; `last` holds the current one

  Impl(const Device& d, const GpuScene& s, const EstimatorSettings& e, const ExecutionSettings& x)
      : device(d), scene(s), estimator(e), execution(x),
        workgroupSize(x.workgroupSize != 0 ? x.workgroupSize : (d.isCpu() ? kCpuWorkgroup : kGpuWorkgroup)),
        tables(d, s.impl().tables, e), sceneView(uploadView()), choice(newChoice()),
        commands(d, kMaxWavesPerSubmit * kDispatchesPerWave, "wavefront") {}

  [[nodiscard]] const gpu::TextureArray& textures() const {
    return placeholderTextures.size() > 0 ? placeholderTextures : scene.impl().textures;
  }
  [[nodiscard]] gpu::Buffer uploadView() const;
  void makeKernels(const Camera& camera, const Film& target);
  void writeRenderView(const Camera& camera, SampleRange range);
  void findCameraMedia();
  void dispatch(const gpu::Kernel& kernel, uint32_t stage);
  void recordPrepare(uint32_t part);
  void recordWave();
  void recordFused();
  void addKernels(Pipeline pipeline);
  void submit(Pipeline pipeline);
  void adapt(Pipeline pipeline);
  void retire();
  /// On GPUs the fused kernel was never measured; with every feature it takes llvmpipe minutes to compile.
  [[nodiscard]] PipelineChoice newChoice() const {
    return {execution.pipeline, device.isCpu() && execution.specialize, execution.compileShare};
  }
  [[nodiscard]] bool startsPaths() const { return accepting && last.nextWork < workEnd; }
  [[nodiscard]] bool done() const { return !startsPaths() && last.counts[gpu::kQueueFree] == pool->capacity; }
  /// Whether the weight of emission that a path finds depends on where light was sampled before.
  [[nodiscard]] bool keepsReceivers() const {
    const FeatureSet& features = scene.features();
    return features.has(Feature::kHasLightTree) &&
           (features.has(Feature::kHasEmissiveTriangles) || features.has(Feature::kHasSphereLights)) &&
           estimator.lightSelection == LightSelection::Bvh && estimator.lightSampling != LightSampling::BsdfOnly;
  }
  [[nodiscard]] gpu::KernelArgs arguments(uint32_t prepare) const;
};

gpu::Buffer PathTracer::Impl::uploadView() const {
  gpu::SceneView view = scene.impl().viewContents;
  tables.writeTo(view);
  return gpu::uploadBuffer(device, std::vector{view}, "render.scene");
}

// The camera's kind is a feature too, so kernels wait for the first camera and film; later ones of another kind remake
// them.
void PathTracer::Impl::makeKernels(const Camera& camera, const Film& target) {
  FeatureSet features = FeatureSet::all();
  if (execution.specialize) {
    features = scene.features();
    if (camera.kind == CameraKind::Orthographic) features.add(Feature::kHasOrthographic);
    if (camera.kind == CameraKind::Panorama) features.add(Feature::kHasPanorama);
    if (camera.hasLens()) features.add(Feature::kHasThinLens);
  }
  const KernelNeeds needs = {.depthLedger = target.options().depthLedger && execution.depthLedger &&
                                            estimator.maxDepth != kUnlimitedDepth,
                             .pixelList = pixelList.bytes() != 0,
                             .backend = scene.statistics().backend};
  if (kernels && features == kernelFeatures && needs == kernelNeeds) return;
  if (needs.depthLedger != kernelNeeds.depthLedger) pool.reset(); // it holds other state
  kernelNeeds = needs;
  const auto start = Clock::now();
  if (features.has(Feature::kHasTextures) && scene.impl().textures.size() == 0) {
    const ImageData white{.name = "placeholder", .width = 1, .height = 1, .pixels = std::vector(4, std::byte{255})};
    const gpu::TextureUpload upload{.image = &white};
    placeholderTextures = gpu::TextureArray(device, {&upload, 1});
  }
  kernels.emplace(device, features, estimator, workgroupSize, textures().layout(), needs);
  kernelFeatures = features;
  choice = newChoice();
  kernels->add(choice.next());
  compileMilliseconds = secondsSince(start) * 1e3;
  totals.compileSeconds += secondsSince(start);
  if (!pool) {
    const uint32_t paths =
        execution.pathPoolSize != 0 ? execution.pathPoolSize : (device.isCpu() ? kCpuPathPool : kGpuPathPool);
    pool.emplace(device, paths,
                 PathPoolParts{.shadows = samplesLights(features, estimator, needs.depthLedger),
                               .interiors = features.has(Feature::kHasTransmission),
                               .receivers = keepsReceivers(),
                               .media = features.has(Feature::kHasVolumes),
                               .scatteringMedia = features.has(Feature::kHasScatteringMedia),
                               .straight = features.has(Feature::kHasTransmission) &&
                                           estimator.shadowTransmission == ShadowTransmission::Straight,
                               .beyond = needs.depthLedger});
    const std::vector<float> filter = filterTable(estimator.filter);
    gpu::writeBuffer(device, pool->filterTable, 0, std::as_bytes(std::span(filter)));
    activeLimit = paths;
  }
}

void PathTracer::Impl::writeRenderView(const Camera& camera, SampleRange range) {
  gpu::RenderView view = renderView(scene.impl(), film->impl(), camera, range, estimator, pool->filterTable.address());
  view.beyondPaths = pool->beyond.address();
  if (kernelNeeds.pixelList) {
    view.pixels = pixelList.address();
    view.paddedPixelCount = static_cast<uint32_t>(pixelList.bytes() / sizeof(uint32_t));
    view.workEnd = uint64_t{view.paddedPixelCount} * (range.last - range.first);
  }
  workEnd = view.workEnd;
  if (range.begun > workEnd) throw UsageError("more of the first sample is done than there is");
  gpu::writeBuffer(device, pool->render, 0, std::as_bytes(std::span(&view, 1)));
}

// Which media the camera is in: asked along many directions, and the most frequent answer taken.
void PathTracer::Impl::findCameraMedia() {
  totals.cameraMedia.clear();
  if (!kernels->findCameraMedia) return;
  const gpu::KernelArgs args = arguments(0);
  commands.begin();
  commands.dispatch(*kernels->findCameraMedia, &args, sizeof(args), textures().set(), 1);
  commands.submitAndWait();
  std::vector<gpu::MediaState> answers(std::min(workgroupSize, pool->capacity));
  gpu::readBuffer(device, pool->media, 0, std::as_writable_bytes(std::span(answers)));
  const gpu::MediumStack found = mostFrequent(answers);
  gpu::writeBuffer(device, pool->render, offsetof(gpu::RenderView, cameraMedia), std::as_bytes(std::span(&found, 1)));
  for (const uint32_t material : found.materials) {
    if (material != gpu::kInvalidIndex) totals.cameraMedia.push_back(scene.impl().materialNames[material]);
  }
}

gpu::KernelArgs PathTracer::Impl::arguments(uint32_t prepare) const {
  return {.scene = sceneView.address(),
          .render = pool->render.address(),
          .wave = pool->wave.address(),
          .queues = pool->queues.address(),
          .rays = pool->rays.address(),
          .hits = pool->hits.address(),
          .paths = pool->paths.address(),
          .shadows = pool->shadows.address(),
          .interiors = pool->interiors.address(),
          .receivers = pool->receivers.address(),
          .media = pool->media.address(),
          .straight = pool->straight.address(),
          .capacity = pool->capacity,
          .activeLimit = accepting ? activeLimit : 0,
          .prepare = prepare,
          .workgroupSize = workgroupSize,
          .steps = stepsPerDispatch};
}

void PathTracer::Impl::recordPrepare(uint32_t part) {
  const gpu::KernelArgs args = arguments(part);
  commands.dispatch(kernels->prepare, &args, sizeof(args), VK_NULL_HANDLE, 1);
}

void PathTracer::Impl::dispatch(const gpu::Kernel& kernel, uint32_t stage) {
  const gpu::KernelArgs args = arguments(0); // `prepare` alone reads that member
  const uint64_t offset = offsetof(gpu::WaveState, dispatches) + stage * sizeof(gpu::DispatchSize);
  commands.dispatchIndirect(kernel, &args, sizeof(args), textures().set(), pool->wave, offset);
}

void PathTracer::Impl::recordWave() {
  const WavefrontKernels& stages = kernels->wavefront.value();
  recordPrepare(gpu::kPrepareRegenerate);
  dispatch(stages.regenerate, gpu::kStageRegenerate);
  recordPrepare(gpu::kPrepareIntersect);
  dispatch(stages.intersectClosest, gpu::kStageIntersectClosest);
  if (stages.shadeMedium) {
    recordPrepare(gpu::kPrepareMedium);
    dispatch(*stages.shadeMedium, gpu::kStageShadeMedium);
  }
  recordPrepare(gpu::kPrepareShade);
  if (stages.shadeEscaped) dispatch(*stages.shadeEscaped, gpu::kStageShadeEscaped);
  dispatch(stages.shadeSurface, gpu::kStageShadeSurface);
  recordPrepare(gpu::kPrepareShadow);
  if (stages.intersectShadow) dispatch(*stages.intersectShadow, gpu::kStageIntersectShadow);
  dispatch(stages.accumulate, gpu::kStageAccumulate);
}

void PathTracer::Impl::recordFused() {
  recordPrepare(gpu::kPrepareFused);
  const gpu::KernelArgs args = arguments(0);
  commands.dispatch(kernels->fused.value(), &args, sizeof(args), textures().set(),
                    (pool->capacity + workgroupSize - 1) / workgroupSize);
  recordPrepare(gpu::kPrepareAfterFused);
}

void PathTracer::Impl::addKernels(Pipeline pipeline) {
  const auto start = Clock::now();
  kernels->add(pipeline);
  totals.compileSeconds += secondsSince(start);
}

void PathTracer::Impl::submit(Pipeline pipeline) {
  commands.begin();
  if (pipeline == Pipeline::Fused) {
    recordFused();
  } else {
    for (uint32_t wave = 0; wave < wavesPerSubmit; ++wave) recordWave();
  }
  commands.copy(pool->wave, pool->readback);
  commands.submitAndWait();
  const uint64_t raysBefore = last.primaryRays + last.bounceRays + last.shadowRays;
  std::memcpy(&last, pool->readback.mapped(), sizeof(last));
  const uint64_t rays = last.primaryRays + last.bounceRays + last.shadowRays - raysBefore;
  PipelineStatistics& done = pipeline == Pipeline::Fused ? totals.fused : totals.wavefront;
  ++done.submits;
  done.rays += rays;
  done.milliseconds += commands.lastSubmitMilliseconds();
  // The end of a render, when no new paths start, tells little.
  if (startsPaths()) choice.add(rays, commands.lastSubmitMilliseconds(), compileMilliseconds);
}

// Work per submit follows the measured times; it never changes the image.
void PathTracer::Impl::adapt(Pipeline pipeline) {
  const bool fused = pipeline == Pipeline::Fused;
  const double limit = std::min(kLongestDispatchMilliseconds, execution.submitMilliseconds);
  // A submit of the fused kernel is one dispatch.
  const double wanted = fused ? limit : execution.submitMilliseconds;
  const double ratio = std::clamp(wanted / std::max(commands.lastSubmitMilliseconds(), 0.1), 0.25, 2.0);
  const auto scaled = [&](uint32_t count, uint32_t most) {
    return static_cast<uint32_t>(std::clamp(std::round(count * ratio), 1.0, static_cast<double>(most)));
  };
  if (fused) {
    stepsPerDispatch = scaled(stepsPerDispatch, kMaxStepsPerDispatch);
    if (startsPaths()) fullSteps = stepsPerDispatch;
  } else {
    wavesPerSubmit = scaled(wavesPerSubmit, kMaxWavesPerSubmit);
  }
  const double longest = commands.lastLongestDispatchMilliseconds();
  if (longest > limit && !(fused && stepsPerDispatch > 1)) {
    const double smaller = activeLimit * std::max(0.25, limit / longest * 0.8);
    activeLimit = std::max(kFewestActivePaths, static_cast<uint32_t>(smaller));
  } else if (longest < 0.5 * limit && activeLimit < pool->capacity) {
    activeLimit = std::min(pool->capacity, activeLimit + activeLimit / 4);
  }
}

// Moves the finished render's counters into the totals.
void PathTracer::Impl::retire() {
  left = {asked.last, asked.last};
  if (last.nextWork < workEnd) {
    const uint64_t places = workEnd / (asked.last - asked.first); // of one sample
    left.first = asked.first + static_cast<uint32_t>(last.nextWork / places);
    left.begun = last.nextWork % places;
  }
  totals.primaryRays += last.primaryRays;
  totals.bounceRays += last.bounceRays;
  totals.shadowRays += last.shadowRays;
  totals.status.queueOverflow += last.status[gpu::kStatusQueueOverflow];
  totals.status.stackOverflow += last.status[gpu::kStatusStackOverflow];
  totals.status.nonFinite += last.status[gpu::kStatusNonFinite];
  totals.status.negative += last.status[gpu::kStatusNegative];
  totals.status.clipped += last.status[gpu::kStatusClipped];
  totals.status.outOfBounds += last.status[gpu::kStatusOutOfBounds];
  totals.status.mediumOverflow += last.status[gpu::kStatusMediumOverflow];
  last = {};
  film = nullptr;
}

PathTracer::PathTracer(const Device& device, const GpuScene& scene, const EstimatorSettings& estimator,
                       const ExecutionSettings& execution) {
  if (estimator.maxDepth == kUnlimitedDepth && !estimator.russianRoulette) {
    throw UsageError("unlimited depth needs Russian roulette: without it a path in a closed lossless scene never ends");
  }
  if (!(estimator.clamp > 0)) throw UsageError("clamp: a sample's largest radiance must be positive");
  impl_ = std::make_unique<Impl>(device, scene, estimator, execution);
}

PathTracer::PathTracer(PathTracer&&) noexcept = default;
PathTracer& PathTracer::operator=(PathTracer&&) noexcept = default;
PathTracer::~PathTracer() = default;

void PathTracer::setSeed(uint64_t seed) { impl_->estimator.seed = seed; }

void PathTracer::setPixels(std::span<const uint32_t> pixels) {
  if (impl_->film != nullptr) throw Error("a render is under way: finish or cancel it first");
  impl_->pixelList = {};
  if (!pixels.empty())
    impl_->pixelList = gpu::uploadBuffer(impl_->device, std::vector(pixels.begin(), pixels.end()), "render.pixels");
}

void PathTracer::begin(const Camera& camera, Film& film, SampleRange range) {
  if (impl_->film != nullptr) throw Error("a render is under way: finish or cancel it first");
  if (range.last < range.first) throw UsageError("the sample range ends before it begins");
  impl_->makeKernels(camera, film);
  impl_->film = &film;
  impl_->accepting = true;
  impl_->writeRenderView(camera, range);
  impl_->findCameraMedia();
  impl_->pool->reset(impl_->device, range.begun);
  impl_->stepsPerDispatch = impl_->fullSteps; // those of the last render's end are too many for a pool at work
  impl_->asked = range;
  impl_->last = {};
  impl_->last.nextWork = range.begun;
  impl_->last.counts[gpu::kQueueFree] = impl_->pool->capacity;
}

bool PathTracer::advance() {
  if (impl_->film == nullptr) return false;
  if (!impl_->done()) {
    const auto start = Clock::now();
    const Pipeline pipeline = impl_->choice.next();
    impl_->addKernels(pipeline); // of the rival, where a race begins
    impl_->submit(pipeline);
    impl_->adapt(pipeline);
    impl_->totals.renderSeconds += secondsSince(start);
    if (impl_->totals.firstPixelSeconds == 0) impl_->totals.firstPixelSeconds = secondsSince(impl_->constructed);
  }
  if (!impl_->done()) return true;
  impl_->retire();
  return false;
}

void PathTracer::finish() {
  impl_->accepting = false;
  while (advance()) {
  }
}

void PathTracer::cancel() {
  if (impl_->film != nullptr) impl_->retire();
}

bool PathTracer::render(const Camera& camera, Film& film, SampleRange range,
                        const std::function<bool(const Progress&)>& onProgress) {
  const auto start = Clock::now();
  begin(camera, film, range);
  const double work = static_cast<double>(std::max<uint64_t>(impl_->workEnd, 1));
  bool completed = true;
  while (advance()) {
    if (!onProgress || !impl_->accepting) continue;
    const gpu::WaveState& state = impl_->last;
    const double started = static_cast<double>(state.nextWork);
    const double inFlight = impl_->pool->capacity - state.counts[gpu::kQueueFree];
    if (!onProgress({.fraction = std::clamp((started - inFlight) / work, 0.0, 1.0),
                     .seconds = secondsSince(start),
                     .rays = state.primaryRays + state.bounceRays + state.shadowRays})) {
      completed = false;
      impl_->accepting = false;
    }
  }
  return completed;
}

SampleRange PathTracer::left() const { return impl_->left; }

RenderStatistics PathTracer::statistics() const {
  RenderStatistics statistics = impl_->totals;
  statistics.primaryRays += impl_->last.primaryRays;
  statistics.bounceRays += impl_->last.bounceRays;
  statistics.shadowRays += impl_->last.shadowRays;
  statistics.workgroupSize = impl_->workgroupSize;
  statistics.pipeline = impl_->choice.next();
  statistics.pipelineIsSettled = impl_->choice.isSettled();
  if (!impl_->kernels) return statistics;
  statistics.queueBytes = impl_->pool->bytes();
  statistics.bytesPerPath = impl_->pool->bytesPerPath();
  statistics.pathPoolSize = impl_->pool->capacity;
  statistics.buffers = impl_->pool->buffers();
  for (const gpu::Buffer& table : impl_->tables.buffers()) statistics.buffers.push_back({table.name(), table.bytes()});
  for (const gpu::Kernel* kernel : impl_->kernels->all()) {
    KernelStatistics entry{.name = kernel->name(),
                           .compileMilliseconds = kernel->compileMilliseconds(),
                           .spirvBytes = kernel->spirvBytes()};
    for (const gpu::KernelTime& time : impl_->commands.times()) {
      if (time.name != entry.name) continue;
      entry.dispatches = time.dispatches;
      entry.milliseconds = time.milliseconds;
      entry.longestMilliseconds = time.longestMilliseconds;
    }
    statistics.kernels.push_back(entry);
    statistics.textureBinding = statistics.textureBinding || kernel->usesTextures();
  }
  return statistics;
}

FeatureSet PathTracer::features() const { return impl_->kernels ? impl_->kernelFeatures : impl_->scene.features(); }

} // namespace isophote
