// The driver's compiled pipelines, kept between runs. Optional in every respect: no failure here is ever reported.
#pragma once

#include <filesystem>

#include <vulkan/vulkan.h>

namespace isophote::gpu {

/// A cache filled from `file` where that was written by the same driver for the same device, else an empty one.
[[nodiscard]] VkPipelineCache loadPipelineCache(VkDevice device, VkPhysicalDevice physical,
                                                const std::filesystem::path& file);

/// Replaces `file` in one step, so that a reader never sees half of it.
void savePipelineCache(VkDevice device, VkPipelineCache cache, const std::filesystem::path& file) noexcept;

} // namespace isophote::gpu
