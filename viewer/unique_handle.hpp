// Owns one Vulkan object of a device.
#pragma once

#include <utility>

#include <vulkan/vulkan.h>

namespace isophote::viewer {

template <class Handle> class UniqueHandle {
public:
  using Destroy = void(VKAPI_PTR*)(VkDevice, Handle, const VkAllocationCallbacks*);

  UniqueHandle() = default;
  UniqueHandle(VkDevice device, Handle handle, Destroy destroy) : device_(device), handle_(handle), destroy_(destroy) {}
  UniqueHandle(UniqueHandle&& other) noexcept { swap(other); }
  UniqueHandle& operator=(UniqueHandle&& other) noexcept {
    UniqueHandle(std::move(other)).swap(*this);
    return *this;
  }
  ~UniqueHandle() {
    if (handle_ != VK_NULL_HANDLE) destroy_(device_, handle_, nullptr);
  }

  [[nodiscard]] Handle get() const { return handle_; }

private:
  VkDevice device_ = VK_NULL_HANDLE;
  Handle handle_ = VK_NULL_HANDLE;
  Destroy destroy_ = nullptr;

  void swap(UniqueHandle& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(handle_, other.handle_);
    std::swap(destroy_, other.destroy_);
  }
};

} // namespace isophote::viewer
