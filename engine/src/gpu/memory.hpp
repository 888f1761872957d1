// Allocates device memory and keeps the account of it.
#pragma once

#include <string>

#include "gpu/buffer.hpp"
#include "gpu/device_impl.hpp"

namespace isophote::gpu {

struct Allocation {
  VkDeviceMemory memory = VK_NULL_HANDLE;
  uint64_t bytes = 0;
  bool hostVisible = false; ///< and coherent
};

/// One allocation for one buffer or image.
/// @param addressable  for a buffer with a device address
/// @param owner        named in the message
/// @throws LimitError with needed and available bytes
[[nodiscard]] Allocation allocateMemory(Device::Impl& device, const VkMemoryRequirements& requirements, Memory memory,
                                        bool addressable, const std::string& owner);

void freeMemory(Device::Impl& device, const Allocation& allocation) noexcept;

} // namespace isophote::gpu
