#include "fault/vulkan_faults.hpp"

#include <cstring>

#include <dlfcn.h>

namespace isophote::fault {
namespace {

VulkanFaults faults;
uint64_t failing = 0;

bool strikes(const char* name, VkResult result) {
  if (!faults.failed.empty()) {
    if (std::strcmp(name, "vkQueueSubmit2") == 0) ++faults.submitsAfterFailed;
    return false;
  }
  faults.calls.emplace_back(name);
  if (faults.calls.size() != failing) return false;
  faults.failed = name;
  faults.result = result;
  return true;
}

template <class Function> Function next(const char* name) { return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name)); }

} // namespace

void armVulkan(uint64_t nth) {
  faults = {};
  failing = nth;
}

const VulkanFaults& vulkanFaults() { return faults; }

} // namespace isophote::fault

#define ISOPHOTE_FAULT(name, result, parameters, arguments)                                                            \
  extern "C" VKAPI_ATTR VkResult VKAPI_CALL name parameters {                                                          \
    static const auto real = isophote::fault::next<PFN_##name>(#name);                                                 \
    return isophote::fault::strikes(#name, result) ? result : real arguments;                                          \
  }
#define ISOPHOTE_FAULT_CREATE(name, Info, Handle)                                                                      \
  ISOPHOTE_FAULT(name, VK_ERROR_OUT_OF_DEVICE_MEMORY,                                                                  \
                 (VkDevice device, const Info* info, const VkAllocationCallbacks* callbacks, Handle* handle),          \
                 (device, info, callbacks, handle))

ISOPHOTE_FAULT_CREATE(vkAllocateMemory, VkMemoryAllocateInfo, VkDeviceMemory)
ISOPHOTE_FAULT_CREATE(vkCreateBuffer, VkBufferCreateInfo, VkBuffer)
ISOPHOTE_FAULT_CREATE(vkCreateImage, VkImageCreateInfo, VkImage)
ISOPHOTE_FAULT_CREATE(vkCreateImageView, VkImageViewCreateInfo, VkImageView)
ISOPHOTE_FAULT_CREATE(vkCreateSampler, VkSamplerCreateInfo, VkSampler)
ISOPHOTE_FAULT_CREATE(vkCreateShaderModule, VkShaderModuleCreateInfo, VkShaderModule)
ISOPHOTE_FAULT_CREATE(vkCreatePipelineLayout, VkPipelineLayoutCreateInfo, VkPipelineLayout)
ISOPHOTE_FAULT_CREATE(vkCreatePipelineCache, VkPipelineCacheCreateInfo, VkPipelineCache)
ISOPHOTE_FAULT_CREATE(vkCreateDescriptorPool, VkDescriptorPoolCreateInfo, VkDescriptorPool)
ISOPHOTE_FAULT_CREATE(vkCreateDescriptorSetLayout, VkDescriptorSetLayoutCreateInfo, VkDescriptorSetLayout)
ISOPHOTE_FAULT_CREATE(vkCreateCommandPool, VkCommandPoolCreateInfo, VkCommandPool)
ISOPHOTE_FAULT_CREATE(vkCreateFence, VkFenceCreateInfo, VkFence)
ISOPHOTE_FAULT_CREATE(vkCreateQueryPool, VkQueryPoolCreateInfo, VkQueryPool)
ISOPHOTE_FAULT(vkCreateComputePipelines, VK_ERROR_OUT_OF_DEVICE_MEMORY,
               (VkDevice device, VkPipelineCache cache, uint32_t count, const VkComputePipelineCreateInfo* infos,
                const VkAllocationCallbacks* callbacks, VkPipeline* pipelines),
               (device, cache, count, infos, callbacks, pipelines))
ISOPHOTE_FAULT(vkAllocateDescriptorSets, VK_ERROR_OUT_OF_DEVICE_MEMORY,
               (VkDevice device, const VkDescriptorSetAllocateInfo* info, VkDescriptorSet* sets), (device, info, sets))
ISOPHOTE_FAULT(vkAllocateCommandBuffers, VK_ERROR_OUT_OF_DEVICE_MEMORY,
               (VkDevice device, const VkCommandBufferAllocateInfo* info, VkCommandBuffer* buffers),
               (device, info, buffers))
ISOPHOTE_FAULT(vkBindBufferMemory, VK_ERROR_OUT_OF_DEVICE_MEMORY,
               (VkDevice device, VkBuffer buffer, VkDeviceMemory memory, VkDeviceSize offset),
               (device, buffer, memory, offset))
ISOPHOTE_FAULT(vkBindImageMemory, VK_ERROR_OUT_OF_DEVICE_MEMORY,
               (VkDevice device, VkImage image, VkDeviceMemory memory, VkDeviceSize offset),
               (device, image, memory, offset))
ISOPHOTE_FAULT(vkMapMemory, VK_ERROR_OUT_OF_HOST_MEMORY,
               (VkDevice device, VkDeviceMemory memory, VkDeviceSize offset, VkDeviceSize size, VkMemoryMapFlags flags,
                void** data),
               (device, memory, offset, size, flags, data))
ISOPHOTE_FAULT(vkBeginCommandBuffer, VK_ERROR_OUT_OF_DEVICE_MEMORY,
               (VkCommandBuffer commands, const VkCommandBufferBeginInfo* info), (commands, info))
ISOPHOTE_FAULT(vkEndCommandBuffer, VK_ERROR_OUT_OF_DEVICE_MEMORY, (VkCommandBuffer commands), (commands))
ISOPHOTE_FAULT(vkQueueSubmit2, VK_ERROR_DEVICE_LOST,
               (VkQueue queue, uint32_t count, const VkSubmitInfo2* submits, VkFence fence),
               (queue, count, submits, fence))
ISOPHOTE_FAULT(vkWaitForFences, VK_ERROR_DEVICE_LOST,
               (VkDevice device, uint32_t count, const VkFence* fences, VkBool32 all, uint64_t timeout),
               (device, count, fences, all, timeout))
