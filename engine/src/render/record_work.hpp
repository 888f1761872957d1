// The dispatches of one submit.
#pragma once

#include "gpu/commands.hpp"
#include "render/path_pool.hpp"
#include "render/wavefront_kernels.hpp"
#include "shared/path_types.h"

namespace isophote {

/// What recording takes: all of it is borrowed, but for the arguments.
struct Recording {
  gpu::CommandStream& commands;
  const RenderKernels& kernels;
  const PathPool& pool;
  VkDescriptorSet textures;
  gpu::KernelArgs arguments; ///< without what one dispatch has to itself
};

constexpr uint32_t kDispatchesPerWave = 12;

/// Every stage once.
void recordWave(const Recording& recording);

/// A dispatch of the fused kernel.
///
/// @param steps     vertices that each slot goes on by
/// @param markFree  the pool does not come from this kernel: slots do not yet say whether they are free
void recordFused(const Recording& recording, uint32_t steps, bool markFree);

} // namespace isophote
