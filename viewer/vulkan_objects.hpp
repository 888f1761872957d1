// The few Vulkan objects the viewer makes for itself.
#pragma once

#include <cstdint>
#include <functional>

#include "isophote/device.hpp"
#include "viewer/unique_handle.hpp"

namespace isophote::viewer {

/// @throws DeviceError naming `call` unless `result` is VK_SUCCESS or VK_SUBOPTIMAL_KHR
void check(VkResult result, const char* call);

struct MemoryBuffer {
  UniqueHandle<VkDeviceMemory> memory;
  UniqueHandle<VkBuffer> buffer;
  uint64_t bytes = 0;
};

/// @param wanted  VkMemoryPropertyFlags the memory must have
[[nodiscard]] MemoryBuffer makeBuffer(const Device& device, uint64_t bytes, VkBufferUsageFlags usage,
                                      VkMemoryPropertyFlags wanted);
[[nodiscard]] uint64_t bufferAddress(const Device& device, const MemoryBuffer& buffer);

struct MemoryImage {
  UniqueHandle<VkDeviceMemory> memory;
  UniqueHandle<VkImage> image;
  VkExtent2D extent{};
};

[[nodiscard]] MemoryImage makeImage(const Device& device, VkExtent2D extent, VkFormat format, VkImageUsageFlags usage);

[[nodiscard]] UniqueHandle<VkSemaphore> makeSemaphore(const Device& device);

[[nodiscard]] UniqueHandle<VkFence> makeFence(const Device& device);
[[nodiscard]] UniqueHandle<VkCommandPool> makeCommandPool(const Device& device);
[[nodiscard]] VkCommandBuffer makeCommandBuffer(const Device& device, VkCommandPool pool);

/// Records with `record`, submits and waits.
void submitOnce(const Device& device, const std::function<void(VkCommandBuffer)>& record);

/// Moves the whole color image from one layout to another, with every access before the barrier done before every
/// access after.
void recordTransition(VkCommandBuffer commands, VkImage image, VkImageLayout from, VkImageLayout to);

} // namespace isophote::viewer
