// The memory barrier between two steps that depend on each other in any way.
#pragma once

#include <vulkan/vulkan.h>

namespace isophote::gpu {

/// Orders everything before against everything after: kernels, indirect arguments, transfers, and the host's reads.
inline void recordFullBarrier(VkCommandBuffer commands) {
  constexpr VkPipelineStageFlags2 kDeviceStages = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT |
                                                  VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT |
                                                  VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
  const VkMemoryBarrier2 barrier{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                 .srcStageMask = kDeviceStages,
                                 .srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT,
                                 .dstStageMask = kDeviceStages | VK_PIPELINE_STAGE_2_HOST_BIT,
                                 .dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT};
  const VkDependencyInfo dependency{
      .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .memoryBarrierCount = 1, .pMemoryBarriers = &barrier};
  vkCmdPipelineBarrier2(commands, &dependency);
}

} // namespace isophote::gpu
