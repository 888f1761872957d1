#include "gpu/acceleration_functions.hpp"

#include "isophote/error.hpp"

#include <string>

namespace isophote::gpu {
namespace {

template <class Function> void load(VkDevice device, const char* name, Function& function) {
  function = reinterpret_cast<Function>(vkGetDeviceProcAddr(device, name));
  if (!function) throw DeviceError(std::string(name) + " is missing, though the device offers its extension");
}

} // namespace

AccelerationFunctions::AccelerationFunctions(VkPhysicalDevice physical, VkDevice device) {
  load(device, "vkCreateAccelerationStructureKHR", create);
  load(device, "vkDestroyAccelerationStructureKHR", destroy);
  load(device, "vkGetAccelerationStructureBuildSizesKHR", buildSizes);
  load(device, "vkGetAccelerationStructureDeviceAddressKHR", address);
  load(device, "vkCmdBuildAccelerationStructuresKHR", build);
  load(device, "vkCmdWriteAccelerationStructuresPropertiesKHR", writeProperties);
  load(device, "vkCmdCopyAccelerationStructureKHR", copy);
  VkPhysicalDeviceProperties2 properties{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &limits};
  vkGetPhysicalDeviceProperties2(physical, &properties);
}

} // namespace isophote::gpu
