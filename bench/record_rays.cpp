#include "record_rays.hpp"

#include "gpu/commands.hpp"
#include "isophote/error.hpp"
#include "render/film_impl.hpp"
#include "render/path_pool.hpp"
#include "render/render_view.hpp"
#include "render/wavefront_kernels.hpp"
#include "upload/filter_table.hpp"

namespace isophote::bench {
namespace {

constexpr uint32_t kWorkgroup = 64;

/// A pool of one path per pixel, all at the same depth: after stage k of the wave its queues hold one generation.
class Generation {
public:
  Generation(const Device& device, const GpuScene& scene, const Camera& camera, uint32_t width, uint32_t height)
      : device_(device), scene_(scene), film_(device, {.width = width, .height = height, .aovs = false}),
        pool_(device, paddedPixels(width, height), {.shadows = true, .interiors = true, .receivers = true}),
        kernels_(device, scene.features(), {}, kWorkgroup, scene.impl().textures.layout()),
        commands_(device, 8, "record") {
    kernels_.add(Pipeline::Wavefront);
    const std::vector<float> filter = filterTable({});
    gpu::writeBuffer(device, pool_.filterTable, 0, std::as_bytes(std::span(filter)));
    const gpu::RenderView view =
        renderView(scene.impl(), film_.impl(), camera, {0, 1}, {}, pool_.filterTable.address());
    gpu::writeBuffer(device, pool_.render, 0, std::as_bytes(std::span(&view, 1)));
    pool_.reset(device, 0);
  }

  void start() { run(kernels_.wavefront->regenerate, gpu::kPrepareRegenerate, gpu::kStageRegenerate); }
  void intersect() { run(kernels_.wavefront->intersectClosest, gpu::kPrepareIntersect, gpu::kStageIntersectClosest); }
  void shade() { run(kernels_.wavefront->shadeSurface, gpu::kPrepareShade, gpu::kStageShadeSurface); }

  [[nodiscard]] RayList rays() const {
    const auto states = read<gpu::RayState>(pool_.rays);
    RayList list{RayQuestion::ClosestHit, {}};
    for (const uint32_t slot : queue(gpu::kQueueRay)) {
      const gpu::RayState& ray = states[slot];
      list.rays.push_back({world(ray.origin), ray.tMin, ray.direction, ray.tMax});
    }
    return list;
  }

  [[nodiscard]] RayList shadowRays() const {
    const auto states = read<gpu::ShadowState>(pool_.shadows);
    RayList list{RayQuestion::Occluded, {}};
    for (const uint32_t slot : queue(gpu::kQueueShadow)) {
      const gpu::ShadowState& ray = states[slot];
      list.rays.push_back({world(ray.origin), 0, ray.direction, ray.tMax});
    }
    return list;
  }

private:
  static uint32_t paddedPixels(uint32_t width, uint32_t height) { return ((width + 7) & ~7u) * ((height + 7) & ~7u); }

  void run(const gpu::Kernel& kernel, uint32_t prepare, uint32_t stage) {
    const gpu::KernelArgs args{.scene = scene_.impl().view.address(),
                               .render = pool_.render.address(),
                               .wave = pool_.wave.address(),
                               .queues = pool_.queues.address(),
                               .rays = pool_.rays.address(),
                               .hits = pool_.hits.address(),
                               .paths = pool_.paths.address(),
                               .shadows = pool_.shadows.address(),
                               .interiors = pool_.interiors.address(),
                               .receivers = pool_.receivers.address(),
                               .capacity = pool_.capacity,
                               .activeLimit = pool_.capacity,
                               .prepare = prepare,
                               .workgroupSize = kWorkgroup};
    commands_.begin();
    commands_.dispatch(kernels_.prepare, &args, sizeof(args), VK_NULL_HANDLE, 1);
    commands_.dispatchIndirect(kernel, &args, sizeof(args), scene_.impl().textures.set(), pool_.wave,
                               offsetof(gpu::WaveState, dispatches) + stage * sizeof(gpu::DispatchSize));
    commands_.submitAndWait();
  }

  [[nodiscard]] glm::vec3 world(glm::vec3 local) const { return {glm::dvec3(local) + scene_.impl().worldOrigin}; }

  template <class T> [[nodiscard]] std::vector<T> read(const gpu::Buffer& buffer) const {
    std::vector<T> values(pool_.capacity);
    gpu::readBuffer(device_, buffer, 0, std::as_writable_bytes(std::span(values)));
    return values;
  }

  [[nodiscard]] std::vector<uint32_t> queue(uint32_t queue) const {
    gpu::WaveState state{};
    gpu::readBuffer(device_, pool_.wave, 0, std::as_writable_bytes(std::span(&state, 1)));
    std::vector<uint32_t> slots(state.counts[queue]);
    gpu::readBuffer(device_, pool_.queues, uint64_t{queue} * pool_.capacity * sizeof(uint32_t),
                    std::as_writable_bytes(std::span(slots)));
    return slots;
  }

  const Device& device_;
  const GpuScene& scene_;
  Film film_;
  PathPool pool_;
  RenderKernels kernels_;
  gpu::CommandStream commands_;
};

} // namespace

std::vector<NamedRays> recordRays(const Device& device, const GpuScene& scene, const Camera& camera, uint32_t width,
                                  uint32_t height, uint32_t bounces) {
  if (scene.features().has(Feature::kHasVolumes)) throw Error("rays of scenes with volumes are not recorded");
  Generation generation(device, scene, camera, width, height);
  std::vector<NamedRays> recorded;
  generation.start();
  recorded.push_back({"primary", generation.rays()});
  RayList shadow;
  for (uint32_t i = 1; i <= bounces; ++i) {
    generation.intersect();
    generation.shade();
    recorded.push_back({"bounce" + std::to_string(i), generation.rays()});
    if (i == 1) shadow = generation.shadowRays();
  }
  recorded.push_back({"shadow", std::move(shadow)});
  return recorded;
}

} // namespace isophote::bench
