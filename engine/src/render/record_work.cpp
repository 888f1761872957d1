#include "render/record_work.hpp"

#include <cstddef>

namespace isophote {
namespace {

void prepare(const Recording& recording, uint32_t part) {
  gpu::KernelArgs arguments = recording.arguments;
  arguments.prepare = part;
  recording.commands.dispatch(recording.kernels.prepare, &arguments, sizeof(arguments), VK_NULL_HANDLE, 1);
}

void runStage(const Recording& recording, const gpu::Kernel& kernel, uint32_t stage) {
  const uint64_t offset = offsetof(gpu::WaveState, dispatches) + stage * sizeof(gpu::DispatchSize);
  recording.commands.dispatchIndirect(kernel, &recording.arguments, sizeof(recording.arguments), recording.textures,
                                      recording.pool.wave, offset);
}

void runFused(const Recording& recording, uint32_t steps) {
  gpu::KernelArgs arguments = recording.arguments;
  arguments.steps = steps;
  const uint32_t groups = (arguments.capacity + arguments.workgroupSize - 1) / arguments.workgroupSize;
  recording.commands.dispatch(recording.kernels.fused.value(), &arguments, sizeof(arguments), recording.textures,
                              groups);
}

} // namespace

void recordWave(const Recording& recording) {
  const WavefrontKernels& stages = recording.kernels.wavefront.value();
  prepare(recording, gpu::kPrepareRegenerate);
  runStage(recording, stages.regenerate, gpu::kStageRegenerate);
  prepare(recording, gpu::kPrepareIntersect);
  runStage(recording, stages.intersectClosest, gpu::kStageIntersectClosest);
  if (stages.shadeMedium) {
    prepare(recording, gpu::kPrepareMedium);
    runStage(recording, *stages.shadeMedium, gpu::kStageShadeMedium);
  }
  prepare(recording, gpu::kPrepareShade);
  if (stages.shadeEscaped) runStage(recording, *stages.shadeEscaped, gpu::kStageShadeEscaped);
  runStage(recording, stages.shadeSurface, gpu::kStageShadeSurface);
  prepare(recording, gpu::kPrepareShadow);
  if (stages.intersectShadow) runStage(recording, *stages.intersectShadow, gpu::kStageIntersectShadow);
  runStage(recording, stages.accumulate, gpu::kStageAccumulate);
}

void recordFused(const Recording& recording, uint32_t steps, bool markFree) {
  if (markFree) runFused(recording, 0);
  prepare(recording, gpu::kPrepareFused);
  runFused(recording, steps);
  prepare(recording, gpu::kPrepareAfterFused);
}

} // namespace isophote
