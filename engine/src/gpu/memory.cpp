#include "gpu/memory.hpp"

#include "isophote/error.hpp"

#include "gpu/vulkan_check.hpp"

#include <algorithm>
#include <vector>

namespace isophote::gpu {
namespace {

constexpr VkMemoryPropertyFlags kLocal = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
constexpr VkMemoryPropertyFlags kShared = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
constexpr VkMemoryPropertyFlags kCached = VK_MEMORY_PROPERTY_HOST_CACHED_BIT; // uncached host reads are very slow

/// Wanted properties, best first.
std::vector<VkMemoryPropertyFlags> preferences(const Device::Impl& device, Memory memory) {
  if (memory == Memory::Host) return {kShared | kCached, kShared};
  if (device.unifiedMemory) return {kLocal | kShared | kCached, kLocal | kShared, kLocal, 0};
  return {kLocal, 0};
}

uint32_t memoryType(const Device::Impl& device, uint32_t allowedTypes, Memory memory, const std::string& owner) {
  for (const VkMemoryPropertyFlags wanted : preferences(device, memory)) {
    for (uint32_t type = 0; type < device.memory.memoryTypeCount; ++type) {
      const bool allowed = (allowedTypes >> type) & 1u;
      if (allowed && (device.memory.memoryTypes[type].propertyFlags & wanted) == wanted) return type;
    }
  }
  throw DeviceError(device.info.name + ": no memory type serves " + owner);
}

/// Bytes of the heap that neither this nor, as far as the driver tells, another program holds.
uint64_t availableBytes(const Device::Impl& device, uint32_t heap) {
  if (!device.memoryBudget) {
    const uint64_t size = device.memory.memoryHeaps[heap].size;
    return size - std::min<uint64_t>(size, device.allocatedBytes);
  }
  VkPhysicalDeviceMemoryBudgetPropertiesEXT budget{.sType =
                                                       VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MEMORY_BUDGET_PROPERTIES_EXT};
  VkPhysicalDeviceMemoryProperties2 properties{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MEMORY_PROPERTIES_2,
                                               .pNext = &budget};
  vkGetPhysicalDeviceMemoryProperties2(device.physical, &properties);
  return budget.heapBudget[heap] - std::min(budget.heapBudget[heap], budget.heapUsage[heap]);
}

} // namespace

Allocation allocateMemory(Device::Impl& device, const VkMemoryRequirements& requirements, Memory memory,
                          bool addressable, const std::string& owner) {
  const std::string needed = owner + " needs " + std::to_string(requirements.size) + " bytes; ";
  if (requirements.size > device.maxAllocationBytes) {
    throw LimitError(needed + device.info.name + " allocates at most " + std::to_string(device.maxAllocationBytes) +
                     " at once");
  }
  const uint32_t type = memoryType(device, requirements.memoryTypeBits, memory, owner);
  // Asked before allocating: software devices hand out memory that does not exist and die when it is touched.
  const uint64_t available = availableBytes(device, device.memory.memoryTypes[type].heapIndex);
  const std::string shortage = needed + std::to_string(available) + " are available on " + device.info.name;
  if (requirements.size > available) throw LimitError(shortage);

  const VkMemoryAllocateFlagsInfo flags{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO,
                                        .flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT};
  const VkMemoryAllocateInfo info{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                  .pNext = addressable ? &flags : nullptr,
                                  .allocationSize = requirements.size,
                                  .memoryTypeIndex = type};
  Allocation allocation{.bytes = requirements.size};
  const VkResult result = vkAllocateMemory(device.handle, &info, nullptr, &allocation.memory);
  if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY || result == VK_ERROR_OUT_OF_HOST_MEMORY) throw LimitError(shortage);
  check(result, "vkAllocateMemory");
  allocation.hostVisible = (device.memory.memoryTypes[type].propertyFlags & kShared) == kShared;
  device.allocatedBytes += allocation.bytes;
  device.name(allocation.memory, VK_OBJECT_TYPE_DEVICE_MEMORY, owner);
  return allocation;
}

void freeMemory(Device::Impl& device, const Allocation& allocation) noexcept {
  if (!allocation.memory) return;
  vkFreeMemory(device.handle, allocation.memory, nullptr);
  device.allocatedBytes -= allocation.bytes;
}

} // namespace isophote::gpu
