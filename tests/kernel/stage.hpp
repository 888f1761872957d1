// One wavefront kernel run on hand-made state: fill the vectors, run a stage, look at the vectors.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "gpu/commands.hpp"
#include "isophote/film.hpp"
#include "isophote/gpu_scene.hpp"
#include "render/film_impl.hpp"
#include "render/path_pool.hpp"
#include "render/wavefront_kernels.hpp"
#include "shared/geometry_types.h"
#include "shared/path_types.h"
#include "support/gpu_device.hpp"
#include "upload/gpu_scene.hpp"

namespace isophote::test {

class Stage {
public:
  static constexpr uint32_t kWorkgroup = 64;
  static constexpr gpu::MediumStack kNoMedia = {
      {gpu::kInvalidIndex, gpu::kInvalidIndex, gpu::kInvalidIndex, gpu::kInvalidIndex}};

  Stage(const Scene& scene, uint32_t capacity, const FilmOptions& filmOptions = {.width = 4, .height = 4})
      : gpuScene(gpuDevice(), scene), film(gpuDevice(), filmOptions),
        pool(gpuDevice(), capacity, {.shadows = true, .interiors = true, .media = true, .scatteringMedia = true}),
        kernels(gpuDevice(), withoutTextures(), {}, kWorkgroup, VK_NULL_HANDLE), rays(capacity), hits(capacity),
        paths(capacity), shadows(capacity), interiors(capacity, {1, 0}),
        media(capacity, {kNoMedia, kNoMedia, 0, 0, 0}) {
    kernels.add(Pipeline::Wavefront);
    for (auto& queue : queues) queue.resize(capacity);
    view.cameraMedia = kNoMedia;
    view.replicates = film.impl().replicates.address();
    view.aovs = film.impl().aovs.address();
    view.imageSize = {filmOptions.width, filmOptions.height};
    view.cropSize = view.imageSize;
    view.tileSize = {1, 1};
    view.tileColumns = filmOptions.width;
    view.paddedPixelCount = filmOptions.width * filmOptions.height;
    view.maxDepth = 0xffffffffu;
    view.radianceScale = std::exp2(static_cast<float>(gpu::kRadianceFractionBits));
    view.distanceScale = 1;
    view.filterTable = pool.filterTable.address();
  }

  /// Uploads everything, dispatches `kernel` over `groups` workgroups `repeats` times, downloads everything.
  void run(const gpu::Kernel& kernel, uint32_t groups, uint32_t prepare = 0, uint32_t repeats = 1) {
    transfer(true);
    gpu::CommandStream commands(gpuDevice(), 1, "stage");
    for (uint32_t i = 0; i < repeats; ++i) {
      commands.begin();
      const gpu::KernelArgs args = arguments(prepare);
      commands.dispatch(kernel, &args, sizeof(args), VK_NULL_HANDLE, groups);
      commands.submitAndWait();
    }
    transfer(false);
  }

  [[nodiscard]] std::vector<gpu::ReplicateSum> filmSums() const {
    std::vector<gpu::ReplicateSum> sums(film.impl().replicates.bytes() / sizeof(gpu::ReplicateSum));
    gpu::readBuffer(gpuDevice(), film.impl().replicates, 0, std::as_writable_bytes(std::span(sums)));
    return sums;
  }

  GpuScene gpuScene;
  Film film;
  PathPool pool;
  RenderKernels kernels;
  gpu::WaveState wave{};
  gpu::RenderView view{};
  uint32_t activeLimit = 0xffffffffu;
  std::array<std::vector<uint32_t>, gpu::kQueueCount> queues;
  std::vector<gpu::RayState> rays;
  std::vector<gpu::HitState> hits;
  std::vector<gpu::PathState> paths;
  std::vector<gpu::ShadowState> shadows;
  std::vector<gpu::InteriorState> interiors;
  std::vector<gpu::MediaState> media;

private:
  // The scenes of these tests have none, and a kernel that reads them would need some.
  [[nodiscard]] static FeatureSet withoutTextures() {
    FeatureSet features = FeatureSet::all();
    features.remove(Feature::kHasTextures);
    return features;
  }

  [[nodiscard]] gpu::KernelArgs arguments(uint32_t prepare) const {
    return {.scene = gpuScene.impl().view.address(),
            .render = pool.render.address(),
            .wave = pool.wave.address(),
            .queues = pool.queues.address(),
            .rays = pool.rays.address(),
            .hits = pool.hits.address(),
            .paths = pool.paths.address(),
            .shadows = pool.shadows.address(),
            .interiors = pool.interiors.address(),
            .media = pool.media.address(),
            .capacity = pool.capacity,
            .activeLimit = activeLimit,
            .prepare = prepare,
            .workgroupSize = kWorkgroup};
  }

  template <class T> static void move(bool up, const gpu::Buffer& buffer, uint64_t offset, std::span<T> values) {
    if (up)
      gpu::writeBuffer(gpuDevice(), buffer, offset, std::as_bytes(values));
    else
      gpu::readBuffer(gpuDevice(), buffer, offset, std::as_writable_bytes(values));
  }

  void transfer(bool up) {
    for (size_t q = 0; q < queues.size(); ++q) {
      move(up, pool.queues, q * pool.capacity * sizeof(uint32_t), std::span(queues[q]));
    }
    move(up, pool.rays, 0, std::span(rays));
    move(up, pool.hits, 0, std::span(hits));
    move(up, pool.paths, 0, std::span(paths));
    move(up, pool.shadows, 0, std::span(shadows));
    move(up, pool.media, 0, std::span(media));
    move(up, pool.interiors, 0, std::span(interiors));
    move(up, pool.wave, 0, std::span(&wave, 1));
    move(up, pool.render, 0, std::span(&view, 1));
  }
};

} // namespace isophote::test
