// Vulkan calls of this executable that fail on demand. Linking this file puts a function of the same name before each
// of the loader's that the engine checks the result of.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <vulkan/vulkan.h>

namespace isophote::fault {

/// What the calls since the last arm() came to.
struct VulkanFaults {
  std::vector<std::string> calls;  ///< functions that could have failed, in the order of their calls up to the fault
  std::string failed;              ///< the function that did; empty: none
  VkResult result = VK_SUCCESS;    ///< what it returned
  uint64_t submitsAfterFailed = 0; ///< vkQueueSubmit2, after the fault
};

/// From now on the `nth` call, counted from 1, fails as its kind does: submits and waits by a lost device, all others
/// for want of device memory. 0: none fails.
void armVulkan(uint64_t nth);

[[nodiscard]] const VulkanFaults& vulkanFaults();

} // namespace isophote::fault
