#include "isophote/path_tracer.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <optional>

#include "gpu/commands.hpp"
#include "isophote/error.hpp"
#include "render/camera_media.hpp"
#include "render/film_impl.hpp"
#include "render/path_pool.hpp"
#include "render/paths_in_flight.hpp"
#include "render/pipeline_choice.hpp"
#include "render/record_work.hpp"
#include "render/render_view.hpp"
#include "render/wavefront_kernels.hpp"
#include "render/work_size.hpp"
#include "shared/geometry_types.h"
#include "upload/filter_table.hpp"
#include "upload/gpu_scene.hpp"
#include "upload/scattering_tables.hpp"

namespace isophote {
namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

constexpr uint32_t kCpuWorkgroup = 64;
constexpr uint32_t kGpuWorkgroup = 128;

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
  PipelineChoice choice;
  gpu::Buffer pixelList; ///< crop pixels to sample; null: all
  std::optional<PathPool> pool;
  gpu::CommandStream commands;

  Film* film = nullptr; ///< of the render under way
  SampleRange asked;    ///< of it
  SampleRange left;     ///< of the last one
  uint64_t workEnd = 0;
  WorkSize work;
  std::array<PathsInFlight, 2> pathsInFlight; ///< by Pipeline
  std::optional<Pipeline> lastPipeline;       ///< of the last submit of this render
  bool accepting = true;                      ///< new samples may start
  gpu::WaveState last{};                      ///< at the end of the last submit
  RenderStatistics totals;                    ///< of finished renders; `last` holds the current one

  Impl(const Device& d, const GpuScene& s, const EstimatorSettings& e, const ExecutionSettings& x)
      : device(d), scene(s), estimator(e), execution(x),
        workgroupSize(x.workgroupSize != 0 ? x.workgroupSize : (d.isCpu() ? kCpuWorkgroup : kGpuWorkgroup)),
        tables(d, s.impl().tables, e), sceneView(uploadView()), choice(newChoice()),
        commands(d, WorkSize::kMostWaves * kDispatchesPerWave, "paths"),
        work(x.submitMilliseconds), pathsInFlight{newPathsInFlight(Pipeline::Wavefront),
                                                  newPathsInFlight(Pipeline::Fused)} {}

  [[nodiscard]] const gpu::TextureArray& textures() const {
    return placeholderTextures.size() > 0 ? placeholderTextures : scene.impl().textures;
  }
  [[nodiscard]] gpu::Buffer uploadView() const;
  void makeKernels(const Camera& camera, const Film& target);
  void writeRenderView(const Camera& camera, SampleRange range);
  void findCameraMedia();
  void addKernels(Pipeline pipeline);
  void submit(Pipeline pipeline);
  void searchPathsInFlight(Pipeline pipeline, uint64_t rays, double milliseconds);
  void retire();
  /// On GPUs the fused kernel was never measured. On CPUs it is as fast or faster by the clock in all scenes that were,
  /// but with all features it takes twice as long to compile.
  [[nodiscard]] PipelineChoice newChoice() const {
    const Pipeline first = device.isCpu() && execution.specialize ? Pipeline::Fused : Pipeline::Wavefront;
    return {execution.pipeline, first, device.isCpu(), execution.compileShare};
  }
  [[nodiscard]] PathsInFlight newPathsInFlight(Pipeline pipeline) const {
    if (execution.pathPoolSize != 0) return PathsInFlight(execution.pathPoolSize);
    return recallPathsInFlight(device, pipeline);
  }
  [[nodiscard]] const PathsInFlight& inFlight(Pipeline pipeline) const {
    return pathsInFlight[static_cast<size_t>(pipeline)];
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
  [[nodiscard]] gpu::KernelArgs arguments(Pipeline pipeline) const;
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
  if (features.has(Feature::kHasTextures) && scene.impl().textures.size() == 0) {
    const ImageData white{.name = "placeholder", .width = 1, .height = 1, .pixels = std::vector(4, std::byte{255})};
    const gpu::TextureUpload upload{.image = &white};
    placeholderTextures = gpu::TextureArray(device, {&upload, 1});
  }
  kernels.emplace(device, features, estimator, workgroupSize, textures().layout(), needs);
  kernelFeatures = features;
  choice = newChoice();
  addKernels(choice.next());
  if (!pool) {
    const uint32_t paths =
        execution.pathPoolSize != 0 ? execution.pathPoolSize : pathsRange(device, Pipeline::Wavefront).most;
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
    work.setCapacity(paths);
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
  const gpu::KernelArgs args = arguments(choice.next());
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

gpu::KernelArgs PathTracer::Impl::arguments(Pipeline pipeline) const {
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
          .activeLimit = accepting ? std::min(work.activeLimit(), inFlight(pipeline).count()) : 0,
          .workgroupSize = workgroupSize};
}

void PathTracer::Impl::addKernels(Pipeline pipeline) {
  const auto start = Clock::now();
  kernels->add(pipeline);
  const double seconds = secondsSince(start);
  totals.compileSeconds += seconds;
  choice.addCompilation(seconds * 1e3);
}

void PathTracer::Impl::submit(Pipeline pipeline) {
  commands.begin();
  const Recording recording{commands, *kernels, *pool, textures().set(), arguments(pipeline)};
  if (pipeline == Pipeline::Fused) {
    recordFused(recording, work.steps(), lastPipeline != Pipeline::Fused);
  } else {
    for (uint32_t wave = 0; wave < work.waves(); ++wave) recordWave(recording);
  }
  commands.copy(pool->wave, pool->readback);
  commands.submitAndWait();
  lastPipeline = pipeline;
  const uint64_t raysBefore = last.primaryRays + last.bounceRays + last.shadowRays;
  std::memcpy(&last, pool->readback.mapped(), sizeof(last));
  const uint64_t rays = last.primaryRays + last.bounceRays + last.shadowRays - raysBefore;
  const double milliseconds = commands.lastSubmitMilliseconds();
  PipelineStatistics& done = pipeline == Pipeline::Fused ? totals.fused : totals.wavefront;
  ++done.submits;
  done.rays += rays;
  done.milliseconds += milliseconds;
  work.follow(pipeline, milliseconds, commands.lastLongestDispatchMilliseconds(), startsPaths());
  // The end of a render, when no new paths start, tells little.
  if (!startsPaths()) return;
  if (!choice.isRacing()) searchPathsInFlight(pipeline, rays, milliseconds);
  choice.add(rays, milliseconds);
}

void PathTracer::Impl::searchPathsInFlight(Pipeline pipeline, uint64_t rays, double milliseconds) {
  PathsInFlight& search = pathsInFlight[static_cast<size_t>(pipeline)];
  // A dispatch that was too long for so many paths tells nothing of them.
  if (search.isSettled() || work.activeLimit() < search.count()) return;
  search.add(rays, milliseconds);
  if (search.isSettled()) rememberPathsInFlight(device, pipeline, search.count());
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
  if (estimator.maxDepth == kUnlimitedDepth && estimator.russianRoulette == RussianRoulette::Off) {
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
  impl_->work.beginRender();
  impl_->lastPipeline.reset();
  impl_->asked = range;
  impl_->last = {};
  impl_->last.nextWork = range.begun;
  impl_->last.counts[gpu::kQueueFree] = impl_->pool->capacity;
}

bool PathTracer::advance() {
  if (impl_->film == nullptr) return false;
  if (!impl_->done()) {
    const Pipeline pipeline = impl_->choice.next();
    impl_->addKernels(pipeline); // of the rival, where a race begins
    const auto start = Clock::now();
    impl_->submit(pipeline);
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
  for (const Pipeline pipeline : {Pipeline::Wavefront, Pipeline::Fused}) {
    PipelineStatistics& of = pipeline == Pipeline::Fused ? statistics.fused : statistics.wavefront;
    of.pathsInFlight = impl_->inFlight(pipeline).count();
    of.pathsInFlightAreSettled = impl_->inFlight(pipeline).isSettled();
  }
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
