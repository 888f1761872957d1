// What a Device owns, and the few operations on it that the other GPU objects share.
#pragma once

#include <atomic>
#include <filesystem>
#include <optional>
#include <string>

#include "gpu/acceleration_functions.hpp"
#include "isophote/device.hpp"

namespace isophote {

struct Device::Impl {
  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl();

  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  VkDevice handle = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;
  uint32_t queueFamily = 0;
  DeviceInfo info;
  VkPhysicalDeviceLimits limits{};
  uint64_t maxAllocationBytes = 0;
  uint64_t maxBufferBytes = 0;
  VkPhysicalDeviceMemoryProperties memory{};
  bool memoryBudget = false;  ///< VK_EXT_memory_budget tells what other programs use
  bool unifiedMemory = false; ///< device memory is the host's: map it instead of staging

  std::optional<gpu::AccelerationFunctions> acceleration; ///< of a device with ray query enabled

  VkPipelineCache cache = VK_NULL_HANDLE;
  std::filesystem::path cacheFile; ///< empty: nowhere to keep it

  // One command buffer for uploads and downloads, which all wait until done.
  VkCommandPool transferPool = VK_NULL_HANDLE;
  VkCommandBuffer transferCommands = VK_NULL_HANDLE;
  VkFence transferFence = VK_NULL_HANDLE;

  std::atomic<uint64_t> allocatedBytes{0};
  std::atomic<bool> lost{false}; ///< nothing may be submitted any more

  PFN_vkSetDebugUtilsObjectNameEXT setName = nullptr;
  PFN_vkCmdBeginDebugUtilsLabelEXT beginLabel = nullptr;
  PFN_vkCmdEndDebugUtilsLabelEXT endLabel = nullptr;

  /// Names an object for debuggers and validation messages, where VK_EXT_debug_utils is present.
  template <class Handle> void name(Handle object, VkObjectType type, const std::string& text) const {
    nameObject(reinterpret_cast<uint64_t>(object), type, text);
  }

  /// Submits and waits.
  /// @param fence  unsignalled; is so again on return
  /// @throws DeviceError on device loss, or when `timeoutSeconds` pass without an answer; the device then takes no more
  /// work
  void submitAndWait(VkCommandBuffer commands, VkFence fence, double timeoutSeconds);

  /// Records by `record(VkCommandBuffer)`, submits and waits. What the device wrote before is visible to the commands,
  /// what they write is visible to the host and to later submissions.
  template <class Record> void transfer(Record record) {
    beginTransfer();
    record(transferCommands);
    finishTransfer();
  }

private:
  void nameObject(uint64_t object, VkObjectType type, const std::string& text) const;
  void beginTransfer();
  void finishTransfer();
};

} // namespace isophote
