#include "render/ray_batch.hpp"

#include <numeric>

#include "isophote/error.hpp"
#include "render/wavefront_kernels.hpp"
#include "shared/geometry_types.h"
#include "upload/gpu_scene.hpp"

namespace isophote {
namespace {

constexpr uint32_t kWorkgroup = 64;

template <class T> void upload(const Device& device, const gpu::Buffer& buffer, const std::vector<T>& values) {
  gpu::writeBuffer(device, buffer, 0, std::as_bytes(std::span(values)));
}

template <class T> std::vector<T> download(const Device& device, const gpu::Buffer& buffer, uint32_t count) {
  std::vector<T> values(count);
  gpu::readBuffer(device, buffer, 0, std::as_writable_bytes(std::span(values)));
  return values;
}

gpu::Kernel makeKernel(const Device& device, const GpuScene& scene, RayQuestion question,
                       const gpu::KernelSource* source) {
  const char* name = question == RayQuestion::Occluded ? "intersect_shadow" : "intersect_closest";
  return {device, source != nullptr ? *source : kernelOf(name, scene.statistics().backend),
          kernelConstants(scene.features(), {}, kWorkgroup), scene.impl().textures.layout(), sizeof(gpu::KernelArgs)};
}

} // namespace

RayBatch::RayBatch(const Device& device, const GpuScene& scene, const RayList& list, const gpu::KernelSource* source)
    : device_(device), scene_(scene), question_(list.question), count_(static_cast<uint32_t>(list.rays.size())),
      pool_(device, std::max(count_, 1u), {.shadows = true}), kernel_(makeKernel(device, scene, list.question, source)),
      commands_(device, 1, "rays") {
  const glm::dvec3 world = scene.impl().worldOrigin;
  const auto local = [&](const Ray& ray) { return glm::vec3(glm::dvec3(ray.origin) - world); };
  std::vector<uint32_t> slots(count_);
  std::iota(slots.begin(), slots.end(), 0u);
  const bool occluded = question_ == RayQuestion::Occluded;
  const uint32_t queue = occluded ? gpu::kQueueShadow : gpu::kQueueRay;
  gpu::writeBuffer(device, pool_.queues, uint64_t{queue} * pool_.capacity * sizeof(uint32_t),
                   std::as_bytes(std::span(slots)));
  if (occluded) {
    std::vector<gpu::ShadowState> shadows;
    for (const Ray& ray : list.rays)
      shadows.push_back({local(ray), ray.tMax, ray.direction, gpu::kInvalidIndex, glm::vec3(1)});
    upload(device, pool_.shadows, shadows);
  } else {
    std::vector<gpu::RayState> rays;
    for (const Ray& ray : list.rays) rays.push_back({local(ray), ray.tMin, ray.direction, ray.tMax});
    upload(device, pool_.rays, rays);
  }
  upload(device, pool_.render, std::vector<gpu::RenderView>(1));
}

void RayBatch::reset() {
  gpu::WaveState state{};
  state.counts[gpu::kQueueRay] = state.counts[gpu::kQueueShadow] = count_;
  upload(device_, pool_.wave, std::vector{state});
  if (question_ == RayQuestion::ClosestHit) {
    upload(device_, pool_.hits,
           std::vector<gpu::HitState>(count_, {gpu::kInvalidIndex, gpu::kInvalidIndex, glm::vec2(0)}));
  }
  upload(device_, pool_.paths, std::vector<gpu::PathState>(count_));
}

void RayBatch::trace() {
  if (count_ == 0) return;
  const gpu::KernelArgs args{.scene = scene_.impl().view.address(),
                             .render = pool_.render.address(),
                             .wave = pool_.wave.address(),
                             .queues = pool_.queues.address(),
                             .rays = pool_.rays.address(),
                             .hits = pool_.hits.address(),
                             .paths = pool_.paths.address(),
                             .shadows = pool_.shadows.address(),
                             .capacity = pool_.capacity,
                             .activeLimit = 0,
                             .prepare = 0,
                             .workgroupSize = kWorkgroup};
  commands_.begin();
  commands_.dispatch(kernel_, &args, sizeof(args), scene_.impl().textures.set(),
                     (count_ + kWorkgroup - 1) / kWorkgroup);
  commands_.submitAndWait();
}

std::vector<gpu::HitState> RayBatch::hits() const { return download<gpu::HitState>(device_, pool_.hits, count_); }

std::vector<bool> RayBatch::met() const {
  std::vector<bool> result;
  if (question_ == RayQuestion::ClosestHit) {
    for (const gpu::HitState& hit : hits()) result.push_back(hit.instance != gpu::kInvalidIndex);
  } else { // what is not occluded received its contribution
    for (const gpu::PathState& path : download<gpu::PathState>(device_, pool_.paths, count_)) {
      result.push_back(path.radiance.x == 0);
    }
  }
  return result;
}

} // namespace isophote
