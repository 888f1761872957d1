// The Vulkan device. The only public header that includes Vulkan.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <vulkan/vulkan.h>

namespace isophote {

/// A device found on this machine, or why it cannot be used.
struct DeviceInfo {
  uint32_t index = 0;
  std::string name;
  std::string driver; ///< driver name and version text
  std::string kind;   ///< "discrete", "integrated", "cpu", "virtual", "other"
  uint32_t subgroupSize = 0;
  uint64_t memoryBytes = 0; ///< largest device-local heap
  bool rayQuery = false;
  std::string rejection; ///< empty: usable; else every missing item, comma separated
};

struct InstanceOptions {
  bool validation = false;             ///< core and synchronization validation; missing layers throw DeviceError
  std::vector<const char*> extensions; ///< a window system's instance extensions
};

/// VkInstance with, on request, the validation layers. Move-only.
class VulkanInstance {
public:
  explicit VulkanInstance(const InstanceOptions& options = {});
  VulkanInstance(VulkanInstance&&) noexcept;
  VulkanInstance& operator=(VulkanInstance&&) noexcept;
  ~VulkanInstance();

  [[nodiscard]] VkInstance handle() const;
  [[nodiscard]] std::vector<DeviceInfo> devices() const;
  /// Validation errors and warnings seen so far, oldest first; empty without validation.
  [[nodiscard]] std::vector<std::string> validationMessages() const;
  void clearValidationMessages();

private:
  friend class Device;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

struct DeviceOptions {
  std::string selector;  ///< name part, index, or "cpu"; empty: the fastest kind present
  bool present = false;  ///< enable VK_KHR_swapchain
  bool rayQuery = false; ///< enable VK_KHR_ray_query, for scenes of Backend::RayQuery; devices without it are refused
};

/// One VkDevice with one queue that computes and transfers (and presents where asked). Borrows the VulkanInstance.
class Device {
public:
  /// @throws DeviceError listing every device with the reason it was refused
  Device(const VulkanInstance& instance, const DeviceOptions& options = {});
  Device(Device&&) noexcept;
  Device& operator=(Device&&) noexcept;
  ~Device();

  [[nodiscard]] VkDevice handle() const;
  [[nodiscard]] VkPhysicalDevice physical() const;
  [[nodiscard]] VkQueue queue() const;
  [[nodiscard]] uint32_t queueFamily() const;
  [[nodiscard]] VkInstance instance() const;
  [[nodiscard]] const DeviceInfo& info() const;
  [[nodiscard]] bool isCpu() const;                    ///< lavapipe and its kind
  [[nodiscard]] double timestampNanoseconds() const;   ///< length of one timestamp tick
  [[nodiscard]] VkPipelineCache pipelineCache() const; ///< kept on disk per device and driver, saved at destruction
  /// Bytes now held by Buffers and textures of this device.
  [[nodiscard]] uint64_t allocatedBytes() const;
  void waitIdle() const;

  struct Impl;
  [[nodiscard]] Impl& impl() const { return *impl_; }

private:
  std::unique_ptr<Impl> impl_;
};

} // namespace isophote
