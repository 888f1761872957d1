// The wavefront's intersection kernels on rays of the caller.
#pragma once

#include <span>
#include <vector>

#include "gpu/commands.hpp"
#include "gpu/kernel.hpp"
#include "isophote/gpu_scene.hpp"
#include "isophote/ray_bench.hpp"
#include "render/path_pool.hpp"

namespace isophote {

class RayBatch {
public:
  /// @param source  the kernel to run in place of the product's, for comparisons
  RayBatch(const Device& device, const GpuScene& scene, const RayList& list, const gpu::KernelSource* source = nullptr);

  /// Empties queues and results; before every trace.
  void reset();
  /// One dispatch over all rays, and waits for it.
  void trace();

  /// Of the last trace of closest hits, in the rays' order; instance kInvalidIndex: nothing met.
  [[nodiscard]] std::vector<gpu::HitState> hits() const;
  /// Of the last trace: per ray, whether it met something.
  [[nodiscard]] std::vector<bool> met() const;

private:
  const Device& device_;
  const GpuScene& scene_;
  RayQuestion question_;
  uint32_t count_;
  PathPool pool_;
  gpu::Kernel kernel_;
  gpu::CommandStream commands_;
};

} // namespace isophote
