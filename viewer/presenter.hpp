// Brings a film to the window.
#pragma once

#include <functional>
#include <optional>

#include "isophote/film.hpp"
#include "isophote/image.hpp"
#include "viewer/swapchain.hpp"
#include "viewer/vulkan_objects.hpp"
#include "viewer/window.hpp"

namespace isophote::viewer {

/// One frame of the window.
struct Frame {
  const Film& film;
  float exposureEv = 0;
  ToneMap toneMap = ToneMap::Neutral;
  std::function<void(VkCommandBuffer)> overlay; ///< draws over the film
  bool keep = false;                            ///< for Presenter::kept
};

/// Surface, swapchain and one frame's commands. Each frame waits for the one before. Borrows device and window.
class Presenter {
public:
  Presenter(const Device& device, const Window& window);
  Presenter(const Presenter&) = delete;
  Presenter& operator=(const Presenter&) = delete;
  ~Presenter();

  [[nodiscard]] VkRenderPass renderPass() const { return renderPass_.get(); }
  [[nodiscard]] uint32_t imageCount() const { return swapchain_->imageCount(); }
  [[nodiscard]] VkExtent2D extent() const { return swapchain_->extent(); }
  /// Follows the window's size. Call while it is not minimized.
  void resize();

  /// Shows the film, scaled to the window, and the overlay.
  /// @return false where the window's size has changed: resize
  bool present(const Frame& frame);

  /// The window's pixels of the last frame with `keep`, display-encoded: for writePng with ToneMap::Linear.
  [[nodiscard]] Image kept() const;

private:
  /// The surface outlives the swapchain and dies before the instance.
  struct Surface {
    VkInstance instance;
    VkSurfaceKHR handle;
    ~Surface() { vkDestroySurfaceKHR(instance, handle, nullptr); }
  };

  const Device& device_;
  const Window& window_;
  Surface surface_;
  VkSurfaceFormatKHR format_;
  UniqueHandle<VkRenderPass> renderPass_;
  std::optional<Swapchain> swapchain_;
  UniqueHandle<VkCommandPool> pool_;
  VkCommandBuffer commands_;
  UniqueHandle<VkFence> done_;
  UniqueHandle<VkSemaphore> acquired_;
  MemoryBuffer pixels_; ///< RGBA8, written by Film::display
  MemoryImage picture_; ///< the same as an image, to scale from
  MemoryBuffer keptPixels_;
  VkExtent2D keptExtent_{};

  void fitPicture(VkExtent2D extent);
  void record(const Frame& frame, uint32_t index);
  void recordPicture(VkImage target) const;
  void recordOverlay(const Frame& frame, uint32_t index) const;
  void recordKeep(VkImage image);
  bool submitAndPresent(uint32_t index);
};

} // namespace isophote::viewer
