#include "viewer/vulkan_objects.hpp"

#include <string>

#include "isophote/error.hpp"

namespace isophote::viewer {
namespace {

uint32_t memoryType(const Device& device, uint32_t allowed, VkMemoryPropertyFlags wanted) {
  VkPhysicalDeviceMemoryProperties properties{};
  vkGetPhysicalDeviceMemoryProperties(device.physical(), &properties);
  for (uint32_t i = 0; i < properties.memoryTypeCount; ++i) {
    const bool fits = (properties.memoryTypes[i].propertyFlags & wanted) == wanted;
    if ((allowed >> i & 1u) != 0 && fits) return i;
  }
  throw DeviceError(device.info().name + ": no memory type for the viewer's buffers");
}

UniqueHandle<VkDeviceMemory> allocate(const Device& device, const VkMemoryRequirements& needs,
                                      VkMemoryPropertyFlags wanted, VkMemoryAllocateFlags flags) {
  const VkMemoryAllocateFlagsInfo flagsInfo{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO, .flags = flags};
  const VkMemoryAllocateInfo info{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                  .pNext = &flagsInfo,
                                  .allocationSize = needs.size,
                                  .memoryTypeIndex = memoryType(device, needs.memoryTypeBits, wanted)};
  VkDeviceMemory memory = VK_NULL_HANDLE;
  check(vkAllocateMemory(device.handle(), &info, nullptr, &memory), "vkAllocateMemory");
  return {device.handle(), memory, vkFreeMemory};
}

} // namespace

void check(VkResult result, const char* call) {
  if (result == VK_SUCCESS || result == VK_SUBOPTIMAL_KHR) return;
  throw DeviceError(std::string(call) + " failed with VkResult " + std::to_string(result));
}

MemoryBuffer makeBuffer(const Device& device, uint64_t bytes, VkBufferUsageFlags usage, VkMemoryPropertyFlags wanted) {
  const VkBufferCreateInfo info{.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = bytes, .usage = usage};
  VkBuffer handle = VK_NULL_HANDLE;
  check(vkCreateBuffer(device.handle(), &info, nullptr, &handle), "vkCreateBuffer");
  MemoryBuffer result;
  result.buffer = {device.handle(), handle, vkDestroyBuffer};
  result.bytes = bytes;
  VkMemoryRequirements needs{};
  vkGetBufferMemoryRequirements(device.handle(), handle, &needs);
  const bool addressed = (usage & VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT) != 0;
  result.memory = allocate(device, needs, wanted, addressed ? VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT : 0);
  check(vkBindBufferMemory(device.handle(), handle, result.memory.get(), 0), "vkBindBufferMemory");
  return result;
}

uint64_t bufferAddress(const Device& device, const MemoryBuffer& buffer) {
  const VkBufferDeviceAddressInfo info{.sType = VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO,
                                       .buffer = buffer.buffer.get()};
  return vkGetBufferDeviceAddress(device.handle(), &info);
}

MemoryImage makeImage(const Device& device, VkExtent2D extent, VkFormat format, VkImageUsageFlags usage) {
  const VkImageCreateInfo info{.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                               .imageType = VK_IMAGE_TYPE_2D,
                               .format = format,
                               .extent = {extent.width, extent.height, 1},
                               .mipLevels = 1,
                               .arrayLayers = 1,
                               .samples = VK_SAMPLE_COUNT_1_BIT,
                               .tiling = VK_IMAGE_TILING_OPTIMAL,
                               .usage = usage};
  VkImage handle = VK_NULL_HANDLE;
  check(vkCreateImage(device.handle(), &info, nullptr, &handle), "vkCreateImage");
  MemoryImage result;
  result.image = {device.handle(), handle, vkDestroyImage};
  result.extent = extent;
  VkMemoryRequirements needs{};
  vkGetImageMemoryRequirements(device.handle(), handle, &needs);
  result.memory = allocate(device, needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 0);
  check(vkBindImageMemory(device.handle(), handle, result.memory.get(), 0), "vkBindImageMemory");
  return result;
}

UniqueHandle<VkSemaphore> makeSemaphore(const Device& device) {
  const VkSemaphoreCreateInfo info{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
  VkSemaphore semaphore = VK_NULL_HANDLE;
  check(vkCreateSemaphore(device.handle(), &info, nullptr, &semaphore), "vkCreateSemaphore");
  return {device.handle(), semaphore, vkDestroySemaphore};
}

UniqueHandle<VkFence> makeFence(const Device& device) {
  const VkFenceCreateInfo info{.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
  VkFence fence = VK_NULL_HANDLE;
  check(vkCreateFence(device.handle(), &info, nullptr, &fence), "vkCreateFence");
  return {device.handle(), fence, vkDestroyFence};
}

UniqueHandle<VkCommandPool> makeCommandPool(const Device& device) {
  const VkCommandPoolCreateInfo info{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                     .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                     .queueFamilyIndex = device.queueFamily()};
  VkCommandPool pool = VK_NULL_HANDLE;
  check(vkCreateCommandPool(device.handle(), &info, nullptr, &pool), "vkCreateCommandPool");
  return {device.handle(), pool, vkDestroyCommandPool};
}

VkCommandBuffer makeCommandBuffer(const Device& device, VkCommandPool pool) {
  const VkCommandBufferAllocateInfo info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                         .commandPool = pool,
                                         .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                         .commandBufferCount = 1};
  VkCommandBuffer commands = VK_NULL_HANDLE;
  check(vkAllocateCommandBuffers(device.handle(), &info, &commands), "vkAllocateCommandBuffers");
  return commands;
}

void submitOnce(const Device& device, const std::function<void(VkCommandBuffer)>& record) {
  const UniqueHandle<VkCommandPool> pool = makeCommandPool(device);
  const VkCommandBuffer commands = makeCommandBuffer(device, pool.get());
  const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                       .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
  check(vkBeginCommandBuffer(commands, &begin), "vkBeginCommandBuffer");
  record(commands);
  check(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
  const VkSubmitInfo submit{
      .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO, .commandBufferCount = 1, .pCommandBuffers = &commands};
  check(vkQueueSubmit(device.queue(), 1, &submit, VK_NULL_HANDLE), "vkQueueSubmit");
  device.waitIdle();
}

void recordTransition(VkCommandBuffer commands, VkImage image, VkImageLayout from, VkImageLayout to) {
  const VkImageMemoryBarrier2 barrier{.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
                                      .srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                      .srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT,
                                      .dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                      .dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT,
                                      .oldLayout = from,
                                      .newLayout = to,
                                      .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                      .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                      .image = image,
                                      .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
  const VkDependencyInfo dependency{
      .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .imageMemoryBarrierCount = 1, .pImageMemoryBarriers = &barrier};
  vkCmdPipelineBarrier2(commands, &dependency);
}

} // namespace isophote::viewer
