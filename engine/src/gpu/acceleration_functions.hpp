// VK_KHR_acceleration_structure on one device: its functions, which the loader does not export, and its limits.
#pragma once

#include <vulkan/vulkan.h>

namespace isophote::gpu {

struct AccelerationFunctions {
  /// @param device  with the extension enabled
  AccelerationFunctions(VkPhysicalDevice physical, VkDevice device);

  PFN_vkCreateAccelerationStructureKHR create;
  PFN_vkDestroyAccelerationStructureKHR destroy;
  PFN_vkGetAccelerationStructureBuildSizesKHR buildSizes;
  PFN_vkGetAccelerationStructureDeviceAddressKHR address;
  PFN_vkCmdBuildAccelerationStructuresKHR build;
  PFN_vkCmdWriteAccelerationStructuresPropertiesKHR writeProperties;
  PFN_vkCmdCopyAccelerationStructureKHR copy;
  VkPhysicalDeviceAccelerationStructurePropertiesKHR limits{
      .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_PROPERTIES_KHR};
};

} // namespace isophote::gpu
