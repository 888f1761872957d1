#include "isophote/device.hpp"

#include "isophote/error.hpp"

#include "gpu/instance_impl.hpp"
#include "gpu/physical_devices.hpp"
#include "gpu/vulkan_check.hpp"

#include <cstring>

namespace isophote {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

bool hasExtension(const char* layer, const char* wanted) {
  uint32_t count = 0;
  gpu::check(vkEnumerateInstanceExtensionProperties(layer, &count, nullptr), "vkEnumerateInstanceExtensionProperties");
  std::vector<VkExtensionProperties> found(count);
  gpu::check(vkEnumerateInstanceExtensionProperties(layer, &count, found.data()),
             "vkEnumerateInstanceExtensionProperties");
  for (const auto& extension : found) {
    if (std::strcmp(extension.extensionName, wanted) == 0) return true;
  }
  return false;
}

bool hasLayer(const char* wanted) {
  uint32_t count = 0;
  gpu::check(vkEnumerateInstanceLayerProperties(&count, nullptr), "vkEnumerateInstanceLayerProperties");
  std::vector<VkLayerProperties> found(count);
  gpu::check(vkEnumerateInstanceLayerProperties(&count, found.data()), "vkEnumerateInstanceLayerProperties");
  for (const auto& layer : found) {
    if (std::strcmp(layer.layerName, wanted) == 0) return true;
  }
  return false;
}

void requireLoader() {
  uint32_t version = 0;
  gpu::check(vkEnumerateInstanceVersion(&version), "vkEnumerateInstanceVersion");
  if (version < VK_API_VERSION_1_3) {
    throw DeviceError("the Vulkan loader is older than 1.3 (it is " + gpu::versionText(version) + ")");
  }
}

} // namespace

VulkanInstance::Impl::~Impl() {
  if (messenger) {
    const auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(handle, "vkDestroyDebugUtilsMessengerEXT"));
    destroy(handle, messenger, nullptr);
  }
  if (handle) vkDestroyInstance(handle, nullptr);
}

VulkanInstance::VulkanInstance(const InstanceOptions& options) : impl_(std::make_unique<Impl>()) {
  requireLoader();
  if (options.validation && !hasLayer(kValidationLayer)) {
    throw DeviceError(std::string("validation was asked for, but the layer ") + kValidationLayer + " is not installed");
  }

  std::vector<const char*> extensions = options.extensions;
  impl_->debugUtils = options.validation || hasExtension(nullptr, VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
  if (impl_->debugUtils) extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
  if (options.validation) extensions.push_back(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);

  const VkApplicationInfo application{.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                      .pApplicationName = "Isophote",
                                      .pEngineName = "Isophote",
                                      .apiVersion = VK_API_VERSION_1_3};
  // The messenger info in the chain covers vkCreateInstance and vkDestroyInstance themselves.
  const VkDebugUtilsMessengerCreateInfoEXT messenger = gpu::messengerInfo(impl_->sink);
  const VkValidationFeatureEnableEXT synchronization = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
  const VkValidationFeaturesEXT features{.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
                                         .pNext = &messenger,
                                         .enabledValidationFeatureCount = 1,
                                         .pEnabledValidationFeatures = &synchronization};
  const VkInstanceCreateInfo info{.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                  .pNext = options.validation ? &features : nullptr,
                                  .pApplicationInfo = &application,
                                  .enabledLayerCount = options.validation ? 1u : 0u,
                                  .ppEnabledLayerNames = &kValidationLayer,
                                  .enabledExtensionCount = static_cast<uint32_t>(extensions.size()),
                                  .ppEnabledExtensionNames = extensions.data()};
  const VkResult result = vkCreateInstance(&info, nullptr, &impl_->handle);
  if (result == VK_ERROR_INCOMPATIBLE_DRIVER) {
    throw DeviceError("no Vulkan driver is installed; a software driver such as Mesa's lavapipe would do");
  }
  gpu::check(result, "vkCreateInstance");
  if (options.validation) {
    const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(impl_->handle, "vkCreateDebugUtilsMessengerEXT"));
    gpu::check(create(impl_->handle, &messenger, nullptr, &impl_->messenger), "vkCreateDebugUtilsMessengerEXT");
  }
}

VulkanInstance::VulkanInstance(VulkanInstance&&) noexcept = default;
VulkanInstance& VulkanInstance::operator=(VulkanInstance&&) noexcept = default;
VulkanInstance::~VulkanInstance() = default;

VkInstance VulkanInstance::handle() const { return impl_->handle; }

std::vector<DeviceInfo> VulkanInstance::devices() const {
  std::vector<DeviceInfo> infos;
  for (auto& candidate : gpu::listPhysicalDevices(impl_->handle, {})) infos.push_back(std::move(candidate.info));
  return infos;
}

std::vector<std::string> VulkanInstance::validationMessages() const { return impl_->sink.messages(); }

void VulkanInstance::clearValidationMessages() { impl_->sink.clear(); }

} // namespace isophote
