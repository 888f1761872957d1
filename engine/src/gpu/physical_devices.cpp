#include "gpu/physical_devices.hpp"

#include "isophote/error.hpp"

#include "gpu/vulkan_check.hpp"

#include <algorithm>
#include <cctype>
#include <cstring>

namespace isophote::gpu {
namespace {

const char* kindName(VkPhysicalDeviceType type) {
  switch (type) {
  case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
    return "discrete";
  case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
    return "integrated";
  case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
    return "virtual";
  case VK_PHYSICAL_DEVICE_TYPE_CPU:
    return "cpu";
  default:
    return "other";
  }
}

/// Smaller is faster.
size_t kindRank(const std::string& kind) {
  constexpr const char* kOrder[] = {"discrete", "integrated", "virtual", "other", "cpu"};
  return static_cast<size_t>(std::find(std::begin(kOrder), std::end(kOrder), kind) - std::begin(kOrder));
}

std::optional<uint32_t> findQueueFamily(VkPhysicalDevice device, bool present) {
  uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
  // A queue that computes also transfers (Vulkan 1.3, 5.3.1); the window's user interface draws on the same queue.
  VkQueueFlags needed = VK_QUEUE_COMPUTE_BIT;
  if (present) needed |= VK_QUEUE_GRAPHICS_BIT;
  for (uint32_t family = 0; family < count; ++family) {
    if ((families[family].queueFlags & needed) == needed && families[family].timestampValidBits > 0) return family;
  }
  return std::nullopt;
}

/// The formats of TextureArray that Vulkan does not promise to filter.
void checkFormats(VkPhysicalDevice device, std::vector<std::string>& missing) {
  constexpr std::pair<VkFormat, const char*> kFormats[] = {
      {VK_FORMAT_R16G16B16A16_UNORM, "filtered R16G16B16A16_UNORM images"},
      {VK_FORMAT_R32G32B32A32_SFLOAT, "filtered R32G32B32A32_SFLOAT images"}};
  constexpr VkFormatFeatureFlags kNeeded = VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT |
                                           VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT |
                                           VK_FORMAT_FEATURE_TRANSFER_DST_BIT;
  for (const auto& [format, text] : kFormats) {
    VkFormatProperties properties{};
    vkGetPhysicalDeviceFormatProperties(device, format, &properties);
    if ((properties.optimalTilingFeatures & kNeeded) != kNeeded) missing.emplace_back(text);
  }
}

void checkFeatures(VkPhysicalDevice device, std::vector<std::string>& missing) {
  DeviceFeatures features;
  vkGetPhysicalDeviceFeatures2(device, &features.core);
  features.visitNeeded([&](const char* name, VkBool32& present) {
    if (!present) missing.emplace_back(name);
  });
}

void checkSubgroups(const VkPhysicalDeviceSubgroupProperties& subgroup, std::vector<std::string>& missing) {
  constexpr VkSubgroupFeatureFlags kNeeded =
      VK_SUBGROUP_FEATURE_BASIC_BIT | VK_SUBGROUP_FEATURE_BALLOT_BIT | VK_SUBGROUP_FEATURE_ARITHMETIC_BIT;
  const bool inCompute = (subgroup.supportedStages & VK_SHADER_STAGE_COMPUTE_BIT) != 0;
  if (!inCompute || (subgroup.supportedOperations & kNeeded) != kNeeded) {
    missing.emplace_back("subgroup ballot and arithmetic operations in compute");
  }
}

uint64_t largestDeviceHeap(VkPhysicalDevice device) {
  VkPhysicalDeviceMemoryProperties memory{};
  vkGetPhysicalDeviceMemoryProperties(device, &memory);
  uint64_t largest = 0;
  for (uint32_t i = 0; i < memory.memoryHeapCount; ++i) {
    const bool local = (memory.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) != 0;
    if (local) largest = std::max<uint64_t>(largest, memory.memoryHeaps[i].size);
  }
  return largest;
}

std::string joined(const std::vector<std::string>& parts) {
  std::string text;
  for (const auto& part : parts) text += (text.empty() ? "" : ", ") + part;
  return text;
}

bool hasRayQuery(VkPhysicalDevice device) {
  for (const char* extension : kRayQueryExtensions) {
    if (!hasDeviceExtension(device, extension)) return false;
  }
  RayQueryFeatures features;
  VkPhysicalDeviceFeatures2 core{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                 .pNext = &features.acceleration};
  vkGetPhysicalDeviceFeatures2(device, &core);
  return features.acceleration.accelerationStructure && features.rayQuery.rayQuery;
}

PhysicalDevice describe(VkPhysicalDevice device, uint32_t index, const DeviceNeeds& needs) {
  VkPhysicalDeviceSubgroupProperties subgroup{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES};
  VkPhysicalDeviceDriverProperties driver{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES,
                                          .pNext = &subgroup};
  VkPhysicalDeviceProperties2 properties{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &driver};
  vkGetPhysicalDeviceProperties2(device, &properties);
  const VkPhysicalDeviceProperties& core = properties.properties;

  PhysicalDevice result{.handle = device};
  result.info.index = index;
  result.info.name = core.deviceName;
  result.info.kind = kindName(core.deviceType);
  result.info.memoryBytes = largestDeviceHeap(device);
  // Older devices may leave the chained structs untouched and cannot be asked for the newer features.
  if (core.apiVersion < VK_API_VERSION_1_3) {
    result.info.rejection = "Vulkan 1.3 (it has " + versionText(core.apiVersion) + ")";
    return result;
  }
  result.info.driver = std::string(driver.driverName) + " " + driver.driverInfo;
  result.info.subgroupSize = subgroup.subgroupSize;
  result.info.rayQuery = hasRayQuery(device);

  std::vector<std::string> missing;
  checkFeatures(device, missing);
  checkSubgroups(subgroup, missing);
  checkFormats(device, missing);
  if (const auto family = findQueueFamily(device, needs.present)) {
    result.queueFamily = *family;
  } else {
    missing.emplace_back(needs.present ? "a queue that draws, computes and has timestamps"
                                       : "a queue that computes and has timestamps");
  }
  if (needs.present && !hasDeviceExtension(device, VK_KHR_SWAPCHAIN_EXTENSION_NAME))
    missing.emplace_back("VK_KHR_swapchain");
  if (needs.rayQuery && !result.info.rayQuery) missing.emplace_back("VK_KHR_ray_query");
  result.info.rejection = joined(missing);
  return result;
}

std::string lowerCase(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

bool matches(const DeviceInfo& info, const std::string& selector) {
  if (selector.empty()) return true;
  const bool isIndex = std::all_of(selector.begin(), selector.end(), [](unsigned char c) { return std::isdigit(c); });
  if (isIndex) return std::to_string(info.index) == selector;
  const std::string wanted = lowerCase(selector);
  if (wanted == "cpu") return info.kind == "cpu";
  return lowerCase(info.name).find(wanted) != std::string::npos;
}

std::string refusal(const std::vector<PhysicalDevice>& devices, const std::string& selector) {
  std::string text = selector.empty() ? "no device can be used" : "no usable device matches '" + selector + "'";
  if (devices.empty())
    return text + ": the Vulkan loader found none; a software driver such as Mesa's lavapipe would do";
  for (const auto& [handle, info, family] : devices) {
    text += "\n  " + std::to_string(info.index) + ": " + info.name + " (" + info.kind + "): ";
    if (!info.rejection.empty()) {
      text += "lacks " + info.rejection;
    } else {
      text += "usable, but does not match '" + selector + "'";
    }
  }
  return text;
}

} // namespace

DeviceFeatures::DeviceFeatures() {
  core.pNext = &v12;
  v12.pNext = &v13;
}

std::string versionText(uint32_t version) {
  return std::to_string(VK_API_VERSION_MAJOR(version)) + "." + std::to_string(VK_API_VERSION_MINOR(version)) + "." +
         std::to_string(VK_API_VERSION_PATCH(version));
}

bool hasDeviceExtension(VkPhysicalDevice device, const char* name) {
  uint32_t count = 0;
  check(vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr), "vkEnumerateDeviceExtensionProperties");
  std::vector<VkExtensionProperties> found(count);
  check(vkEnumerateDeviceExtensionProperties(device, nullptr, &count, found.data()),
        "vkEnumerateDeviceExtensionProperties");
  return std::any_of(found.begin(), found.end(),
                     [&](const auto& extension) { return std::strcmp(extension.extensionName, name) == 0; });
}

std::vector<PhysicalDevice> listPhysicalDevices(VkInstance instance, const DeviceNeeds& needs) {
  uint32_t count = 0;
  check(vkEnumeratePhysicalDevices(instance, &count, nullptr), "vkEnumeratePhysicalDevices");
  std::vector<VkPhysicalDevice> handles(count);
  check(vkEnumeratePhysicalDevices(instance, &count, handles.data()), "vkEnumeratePhysicalDevices");
  std::vector<PhysicalDevice> devices;
  for (uint32_t i = 0; i < count; ++i) devices.push_back(describe(handles[i], i, needs));
  return devices;
}

const PhysicalDevice& selectPhysicalDevice(const std::vector<PhysicalDevice>& devices, const std::string& selector) {
  const PhysicalDevice* best = nullptr;
  for (const auto& device : devices) {
    if (!device.info.rejection.empty() || !matches(device.info, selector)) continue;
    if (!best || kindRank(device.info.kind) < kindRank(best->info.kind)) best = &device;
  }
  if (!best) throw DeviceError(refusal(devices, selector));
  return *best;
}

} // namespace isophote::gpu
