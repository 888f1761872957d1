// The devices of this machine, with what each lacks.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "isophote/device.hpp"

namespace isophote::gpu {

struct PhysicalDevice {
  VkPhysicalDevice handle = VK_NULL_HANDLE;
  DeviceInfo info;          ///< info.rejection is empty where the device can be used
  uint32_t queueFamily = 0; ///< of a usable device
};

/// What only some programs ask of a device.
struct DeviceNeeds {
  bool present = false;  ///< a swapchain and a queue that draws
  bool rayQuery = false; ///< what kRayQueryExtensions and RayQueryFeatures name
};

/// Every device the loader offers, in its order.
[[nodiscard]] std::vector<PhysicalDevice> listPhysicalDevices(VkInstance instance, const DeviceNeeds& needs);

/// The usable device that `selector` means (see DeviceOptions): the fastest kind among those that match.
/// @throws DeviceError listing every device with the reason it was refused
[[nodiscard]] const PhysicalDevice& selectPhysicalDevice(const std::vector<PhysicalDevice>& devices,
                                                         const std::string& selector);

[[nodiscard]] bool hasDeviceExtension(VkPhysicalDevice device, const char* name);

/// "1.3.239"
[[nodiscard]] std::string versionText(uint32_t version);

/// The features every Isophote device has enabled, chained for VkDeviceCreateInfo. Not copyable: it points into itself.
struct DeviceFeatures {
  DeviceFeatures();
  DeviceFeatures(const DeviceFeatures&) = delete;
  DeviceFeatures& operator=(const DeviceFeatures&) = delete;

  VkPhysicalDeviceFeatures2 core{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
  VkPhysicalDeviceVulkan12Features v12{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
  VkPhysicalDeviceVulkan13Features v13{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};

  /// Calls visit(name, flag) for each feature that Isophote needs.
  template <class Visitor> void visitNeeded(Visitor visit) {
    visit("shaderInt64", core.features.shaderInt64);
    visit("bufferDeviceAddress", v12.bufferDeviceAddress);
    visit("scalarBlockLayout", v12.scalarBlockLayout);
    visit("shaderBufferInt64Atomics", v12.shaderBufferInt64Atomics);
    visit("runtimeDescriptorArray", v12.runtimeDescriptorArray);
    visit("shaderSampledImageArrayNonUniformIndexing", v12.shaderSampledImageArrayNonUniformIndexing);
    visit("hostQueryReset", v12.hostQueryReset);
    visit("synchronization2", v13.synchronization2);
  }
};

/// Ray query and what it builds upon.
inline constexpr const char* kRayQueryExtensions[] = {VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME,
                                                      VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME,
                                                      VK_KHR_RAY_QUERY_EXTENSION_NAME};

/// Their features, chained for DeviceFeatures. Not copyable: it points into itself.
struct RayQueryFeatures {
  RayQueryFeatures() { acceleration.pNext = &rayQuery; }
  RayQueryFeatures(const RayQueryFeatures&) = delete;
  RayQueryFeatures& operator=(const RayQueryFeatures&) = delete;

  VkPhysicalDeviceAccelerationStructureFeaturesKHR acceleration{
      .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR};
  VkPhysicalDeviceRayQueryFeaturesKHR rayQuery{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_QUERY_FEATURES_KHR};
};

} // namespace isophote::gpu
