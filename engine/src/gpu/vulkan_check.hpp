// Turns VkResult into the exceptions of isophote/error.hpp.
#pragma once

#include <vulkan/vulkan.h>

namespace isophote::gpu {

/// "VK_ERROR_DEVICE_LOST" and so on; "an unnamed VkResult" for codes this build does not know.
[[nodiscard]] const char* resultName(VkResult result);

/// Returns on any success code.
/// @param call  the Vulkan function that returned `result`, for the message
/// @throws LimitError when memory ran out, DeviceError on every other failure
void check(VkResult result, const char* call);

} // namespace isophote::gpu
