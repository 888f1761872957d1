#include "gpu/device_impl.hpp"

#include "isophote/error.hpp"

#include "gpu/barrier.hpp"
#include "gpu/cache_file.hpp"
#include "gpu/instance_impl.hpp"
#include "gpu/physical_devices.hpp"
#include "gpu/pipeline_cache.hpp"
#include "gpu/vulkan_check.hpp"

namespace isophote {
namespace {

/// A transfer moves at most the staging size; longer than this means the driver hangs.
constexpr double kTransferTimeoutSeconds = 600;

void createLogicalDevice(Device::Impl& impl, const DeviceOptions& options) {
  gpu::DeviceFeatures features;
  features.visitNeeded([](const char*, VkBool32& enabled) { enabled = VK_TRUE; });
  gpu::RayQueryFeatures rayQuery;
  rayQuery.acceleration.accelerationStructure = VK_TRUE;
  rayQuery.rayQuery.rayQuery = VK_TRUE;
  std::vector<const char*> extensions;
  if (impl.memoryBudget) extensions.push_back(VK_EXT_MEMORY_BUDGET_EXTENSION_NAME);
  if (options.present) extensions.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
  if (options.rayQuery) {
    extensions.insert(extensions.end(), std::begin(gpu::kRayQueryExtensions), std::end(gpu::kRayQueryExtensions));
    rayQuery.rayQuery.pNext = features.core.pNext;
    features.core.pNext = &rayQuery.acceleration;
  }
  const float priority = 1;
  const VkDeviceQueueCreateInfo queue{.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                      .queueFamilyIndex = impl.queueFamily,
                                      .queueCount = 1,
                                      .pQueuePriorities = &priority};
  const VkDeviceCreateInfo info{.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                .pNext = &features.core,
                                .queueCreateInfoCount = 1,
                                .pQueueCreateInfos = &queue,
                                .enabledExtensionCount = static_cast<uint32_t>(extensions.size()),
                                .ppEnabledExtensionNames = extensions.data()};
  gpu::check(vkCreateDevice(impl.physical, &info, nullptr, &impl.handle), "vkCreateDevice");
  vkGetDeviceQueue(impl.handle, impl.queueFamily, 0, &impl.queue);
}

void readLimits(Device::Impl& impl) {
  VkPhysicalDeviceVulkan13Properties v13{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_PROPERTIES};
  VkPhysicalDeviceVulkan11Properties v11{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES,
                                         .pNext = &v13};
  VkPhysicalDeviceProperties2 properties{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &v11};
  vkGetPhysicalDeviceProperties2(impl.physical, &properties);
  impl.limits = properties.properties.limits;
  impl.maxAllocationBytes = v11.maxMemoryAllocationSize;
  impl.maxBufferBytes = v13.maxBufferSize;
  impl.unifiedMemory = impl.info.kind == "cpu" || impl.info.kind == "integrated";
  impl.memoryBudget = gpu::hasDeviceExtension(impl.physical, VK_EXT_MEMORY_BUDGET_EXTENSION_NAME);
  vkGetPhysicalDeviceMemoryProperties(impl.physical, &impl.memory);
}

void loadDebugFunctions(Device::Impl& impl) {
  const auto load = [&](const char* name) { return vkGetInstanceProcAddr(impl.instance, name); };
  impl.setName = reinterpret_cast<PFN_vkSetDebugUtilsObjectNameEXT>(load("vkSetDebugUtilsObjectNameEXT"));
  impl.beginLabel = reinterpret_cast<PFN_vkCmdBeginDebugUtilsLabelEXT>(load("vkCmdBeginDebugUtilsLabelEXT"));
  impl.endLabel = reinterpret_cast<PFN_vkCmdEndDebugUtilsLabelEXT>(load("vkCmdEndDebugUtilsLabelEXT"));
}

void createTransferObjects(Device::Impl& impl) {
  const VkCommandPoolCreateInfo pool{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                     .flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT,
                                     .queueFamilyIndex = impl.queueFamily};
  gpu::check(vkCreateCommandPool(impl.handle, &pool, nullptr, &impl.transferPool), "vkCreateCommandPool");
  const VkCommandBufferAllocateInfo commands{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                             .commandPool = impl.transferPool,
                                             .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                             .commandBufferCount = 1};
  gpu::check(vkAllocateCommandBuffers(impl.handle, &commands, &impl.transferCommands), "vkAllocateCommandBuffers");
  const VkFenceCreateInfo fence{.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
  gpu::check(vkCreateFence(impl.handle, &fence, nullptr, &impl.transferFence), "vkCreateFence");
  impl.name(impl.transferCommands, VK_OBJECT_TYPE_COMMAND_BUFFER, "transfer");
}

} // namespace

Device::Impl::~Impl() {
  if (!handle) return;
  vkDeviceWaitIdle(handle);
  if (cache) {
    gpu::savePipelineCache(handle, cache, cacheFile);
    vkDestroyPipelineCache(handle, cache, nullptr);
  }
  if (transferFence) vkDestroyFence(handle, transferFence, nullptr);
  if (transferPool) vkDestroyCommandPool(handle, transferPool, nullptr);
  vkDestroyDevice(handle, nullptr);
}

void Device::Impl::nameObject(uint64_t object, VkObjectType type, const std::string& text) const {
  if (!setName) return;
  const VkDebugUtilsObjectNameInfoEXT named{.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT,
                                            .objectType = type,
                                            .objectHandle = object,
                                            .pObjectName = text.c_str()};
  setName(handle, &named); // a name that could not be kept changes nothing
}

void Device::Impl::submitAndWait(VkCommandBuffer commands, VkFence fence, double timeoutSeconds) {
  if (lost) throw DeviceError(info.name + ": the device was lost earlier and takes no more work");
  const VkCommandBufferSubmitInfo buffer{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                         .commandBuffer = commands};
  const VkSubmitInfo2 submit{
      .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2, .commandBufferInfoCount = 1, .pCommandBufferInfos = &buffer};
  VkResult result = vkQueueSubmit2(queue, 1, &submit, fence);
  if (result == VK_SUCCESS) {
    result = vkWaitForFences(handle, 1, &fence, VK_TRUE, static_cast<uint64_t>(timeoutSeconds * 1e9));
    // After a failed wait the device may still be at work on what the caller destroys when this throws.
    if (result != VK_SUCCESS) vkDeviceWaitIdle(handle);
  }
  if (result == VK_TIMEOUT) {
    lost = true;
    throw DeviceError(info.name + ": no answer after " + std::to_string(timeoutSeconds) + " seconds");
  }
  if (result == VK_ERROR_DEVICE_LOST) {
    lost = true;
    throw DeviceError(info.name + ": device lost (VK_ERROR_DEVICE_LOST): the driver stopped or reset the device");
  }
  gpu::check(result, "vkQueueSubmit2");
  gpu::check(vkResetFences(handle, 1, &fence), "vkResetFences");
}

void Device::Impl::beginTransfer() {
  gpu::check(vkResetCommandPool(handle, transferPool, 0), "vkResetCommandPool");
  const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                       .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
  gpu::check(vkBeginCommandBuffer(transferCommands, &begin), "vkBeginCommandBuffer");
  gpu::recordFullBarrier(transferCommands);
}

void Device::Impl::finishTransfer() {
  gpu::recordFullBarrier(transferCommands);
  gpu::check(vkEndCommandBuffer(transferCommands), "vkEndCommandBuffer");
  submitAndWait(transferCommands, transferFence, kTransferTimeoutSeconds);
}

Device::Device(const VulkanInstance& instance, const DeviceOptions& options) : impl_(std::make_unique<Impl>()) {
  const auto devices = gpu::listPhysicalDevices(instance.handle(), {options.present, options.rayQuery});
  const gpu::PhysicalDevice& chosen = gpu::selectPhysicalDevice(devices, options.selector);
  impl_->instance = instance.handle();
  impl_->physical = chosen.handle;
  impl_->queueFamily = chosen.queueFamily;
  impl_->info = chosen.info;
  readLimits(*impl_);
  createLogicalDevice(*impl_, options);
  if (options.rayQuery) impl_->acceleration.emplace(impl_->physical, impl_->handle);
  if (instance.impl_->debugUtils) loadDebugFunctions(*impl_);
  impl_->name(impl_->handle, VK_OBJECT_TYPE_DEVICE, "isophote");
  impl_->name(impl_->queue, VK_OBJECT_TYPE_QUEUE, "isophote");
  createTransferObjects(*impl_);
  impl_->cacheFile = gpu::cacheFile(impl_->physical, ".bin");
  impl_->cache = gpu::loadPipelineCache(impl_->handle, impl_->physical, impl_->cacheFile);
}

Device::Device(Device&&) noexcept = default;
Device& Device::operator=(Device&&) noexcept = default;
Device::~Device() = default;

VkDevice Device::handle() const { return impl_->handle; }
VkPhysicalDevice Device::physical() const { return impl_->physical; }
VkQueue Device::queue() const { return impl_->queue; }
uint32_t Device::queueFamily() const { return impl_->queueFamily; }
VkInstance Device::instance() const { return impl_->instance; }
const DeviceInfo& Device::info() const { return impl_->info; }
bool Device::isCpu() const { return impl_->info.kind == "cpu"; }
double Device::timestampNanoseconds() const { return static_cast<double>(impl_->limits.timestampPeriod); }
VkPipelineCache Device::pipelineCache() const { return impl_->cache; }
uint64_t Device::allocatedBytes() const { return impl_->allocatedBytes; }
void Device::waitIdle() const { gpu::check(vkDeviceWaitIdle(impl_->handle), "vkDeviceWaitIdle"); }

} // namespace isophote
