// The images of a window.
#pragma once

#include <vector>

#include "isophote/device.hpp"
#include "viewer/unique_handle.hpp"

namespace isophote::viewer {

/// One VkSwapchainKHR with its images' views, framebuffers and semaphores. Borrows device, surface and render pass.
class Swapchain {
public:
  /// @throws DeviceError where the surface cannot be drawn to in the way the viewer does
  Swapchain(const Device& device, VkSurfaceKHR surface, VkExtent2D wanted, VkSurfaceFormatKHR format,
            VkRenderPass renderPass, VkSwapchainKHR old);

  [[nodiscard]] VkSwapchainKHR handle() const { return handle_.get(); }
  [[nodiscard]] VkExtent2D extent() const { return extent_; }
  [[nodiscard]] uint32_t imageCount() const { return static_cast<uint32_t>(images_.size()); }
  [[nodiscard]] VkImage image(uint32_t index) const { return images_[index]; }
  [[nodiscard]] VkFramebuffer framebuffer(uint32_t index) const { return framebuffers_[index].get(); }
  /// Signaled when image `index` is drawn; presentation waits for it.
  [[nodiscard]] VkSemaphore drawn(uint32_t index) const { return drawn_[index].get(); }

private:
  UniqueHandle<VkSwapchainKHR> handle_;
  VkExtent2D extent_{};
  std::vector<VkImage> images_;
  std::vector<UniqueHandle<VkImageView>> views_;
  std::vector<UniqueHandle<VkFramebuffer>> framebuffers_;
  std::vector<UniqueHandle<VkSemaphore>> drawn_;
};

/// 8-bit UNORM: the film is encoded for display already.
/// @throws DeviceError where the surface offers none
[[nodiscard]] VkSurfaceFormatKHR chooseFormat(const Device& device, VkSurfaceKHR surface);

} // namespace isophote::viewer
