#include "viewer/presenter.hpp"

#include <cstring>

#include "isophote/error.hpp"

namespace isophote::viewer {
namespace {

constexpr VkImageLayout kUndefined = VK_IMAGE_LAYOUT_UNDEFINED;
constexpr VkImageLayout kWritten = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
constexpr VkImageLayout kRead = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
constexpr VkImageLayout kDrawn = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
constexpr VkImageLayout kShown = VK_IMAGE_LAYOUT_PRESENT_SRC_KHR;
constexpr VkImageSubresourceLayers kColor{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};

VkSurfaceKHR presentableSurface(const Device& device, const Window& window) {
  const VkSurfaceKHR surface = window.makeSurface(device.instance());
  VkBool32 supported = VK_FALSE;
  check(vkGetPhysicalDeviceSurfaceSupportKHR(device.physical(), device.queueFamily(), surface, &supported),
        "vkGetPhysicalDeviceSurfaceSupportKHR");
  if (supported == VK_FALSE) {
    vkDestroySurfaceKHR(device.instance(), surface, nullptr);
    throw DeviceError(device.info().name + " cannot present to this window; choose another --device");
  }
  return surface;
}

// Draws over what the image holds already; the layouts around it are the presenter's business.
UniqueHandle<VkRenderPass> makeRenderPass(const Device& device, VkFormat format) {
  const VkAttachmentDescription attachment{.format = format,
                                           .samples = VK_SAMPLE_COUNT_1_BIT,
                                           .loadOp = VK_ATTACHMENT_LOAD_OP_LOAD,
                                           .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                           .stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE,
                                           .stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE,
                                           .initialLayout = kDrawn,
                                           .finalLayout = kDrawn};
  const VkAttachmentReference reference{0, kDrawn};
  const VkSubpassDescription subpass{
      .pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS, .colorAttachmentCount = 1, .pColorAttachments = &reference};
  const VkRenderPassCreateInfo info{.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                    .attachmentCount = 1,
                                    .pAttachments = &attachment,
                                    .subpassCount = 1,
                                    .pSubpasses = &subpass};
  VkRenderPass pass = VK_NULL_HANDLE;
  check(vkCreateRenderPass(device.handle(), &info, nullptr, &pass), "vkCreateRenderPass");
  return {device.handle(), pass, vkDestroyRenderPass};
}

} // namespace

Presenter::Presenter(const Device& device, const Window& window)
    : device_(device), window_(window), surface_{device.instance(), presentableSurface(device, window)},
      format_(chooseFormat(device, surface_.handle)), renderPass_(makeRenderPass(device, format_.format)),
      pool_(makeCommandPool(device)), commands_(makeCommandBuffer(device, pool_.get())), done_(makeFence(device)),
      acquired_(makeSemaphore(device)) {
  resize();
}

Presenter::~Presenter() { vkDeviceWaitIdle(device_.handle()); }

void Presenter::resize() {
  device_.waitIdle(); // images and semaphores of the old swapchain may be in use by the presentation engine
  const VkSwapchainKHR old = swapchain_ ? swapchain_->handle() : VK_NULL_HANDLE;
  swapchain_ = Swapchain(device_, surface_.handle, window_.framebufferSize(), format_, renderPass_.get(), old);
}

void Presenter::fitPicture(VkExtent2D extent) {
  if (picture_.extent.width == extent.width && picture_.extent.height == extent.height) return;
  pixels_ = makeBuffer(device_, uint64_t{4} * extent.width * extent.height,
                       VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT |
                           VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                       VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
  picture_ = makeImage(device_, extent, VK_FORMAT_R8G8B8A8_UNORM,
                       VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
}

// The film's pixels into the window's image, whatever the two sizes and channel orders.
void Presenter::recordPicture(VkImage target) const {
  recordTransition(commands_, picture_.image.get(), kUndefined, kWritten);
  const VkExtent2D from = picture_.extent;
  const VkBufferImageCopy copy{.imageSubresource = kColor, .imageExtent = {from.width, from.height, 1}};
  vkCmdCopyBufferToImage(commands_, pixels_.buffer.get(), picture_.image.get(), kWritten, 1, &copy);
  recordTransition(commands_, picture_.image.get(), kWritten, kRead);
  recordTransition(commands_, target, kUndefined, kWritten);
  const VkExtent2D to = swapchain_->extent();
  const VkImageBlit blit{
      .srcSubresource = kColor,
      .srcOffsets = {{0, 0, 0}, {static_cast<int32_t>(from.width), static_cast<int32_t>(from.height), 1}},
      .dstSubresource = kColor,
      .dstOffsets = {{0, 0, 0}, {static_cast<int32_t>(to.width), static_cast<int32_t>(to.height), 1}}};
  vkCmdBlitImage(commands_, picture_.image.get(), kRead, target, kWritten, 1, &blit, VK_FILTER_LINEAR);
}

void Presenter::recordOverlay(const Frame& frame, uint32_t index) const {
  const VkRenderPassBeginInfo info{.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                   .renderPass = renderPass_.get(),
                                   .framebuffer = swapchain_->framebuffer(index),
                                   .renderArea = {{0, 0}, swapchain_->extent()}};
  vkCmdBeginRenderPass(commands_, &info, VK_SUBPASS_CONTENTS_INLINE);
  frame.overlay(commands_);
  vkCmdEndRenderPass(commands_);
}

void Presenter::recordKeep(VkImage image) {
  keptExtent_ = swapchain_->extent();
  keptPixels_ =
      makeBuffer(device_, uint64_t{4} * keptExtent_.width * keptExtent_.height, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                 VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
  const VkBufferImageCopy copy{.imageSubresource = kColor, .imageExtent = {keptExtent_.width, keptExtent_.height, 1}};
  recordTransition(commands_, image, kDrawn, kRead);
  vkCmdCopyImageToBuffer(commands_, image, kRead, keptPixels_.buffer.get(), 1, &copy);
  const VkMemoryBarrier2 toHost{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                .srcStageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                                .srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                .dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT,
                                .dstAccessMask = VK_ACCESS_2_HOST_READ_BIT};
  const VkDependencyInfo dependency{
      .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .memoryBarrierCount = 1, .pMemoryBarriers = &toHost};
  vkCmdPipelineBarrier2(commands_, &dependency);
  recordTransition(commands_, image, kRead, kShown);
}

void Presenter::record(const Frame& frame, uint32_t index) {
  const VkImage image = swapchain_->image(index);
  const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                       .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
  check(vkBeginCommandBuffer(commands_, &begin), "vkBeginCommandBuffer");
  recordPicture(image);
  recordTransition(commands_, image, kWritten, kDrawn);
  recordOverlay(frame, index);
  if (frame.keep) {
    recordKeep(image);
  } else {
    recordTransition(commands_, image, kDrawn, kShown);
  }
  check(vkEndCommandBuffer(commands_), "vkEndCommandBuffer");
}

bool Presenter::present(const Frame& frame) {
  const FilmOptions& size = frame.film.options();
  fitPicture({size.width, size.height});
  frame.film.display(bufferAddress(device_, pixels_), frame.exposureEv, frame.toneMap);

  uint32_t index = 0;
  const VkResult acquired = vkAcquireNextImageKHR(device_.handle(), swapchain_->handle(), UINT64_MAX, acquired_.get(),
                                                  VK_NULL_HANDLE, &index);
  if (acquired == VK_ERROR_OUT_OF_DATE_KHR) return false;
  check(acquired, "vkAcquireNextImageKHR");
  record(frame, index);
  return submitAndPresent(index) && acquired == VK_SUCCESS;
}

bool Presenter::submitAndPresent(uint32_t index) {
  const VkSemaphore acquired = acquired_.get();
  const VkSemaphore drawn = swapchain_->drawn(index);
  const VkPipelineStageFlags waitAt = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
  const VkSubmitInfo submit{.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                            .waitSemaphoreCount = 1,
                            .pWaitSemaphores = &acquired,
                            .pWaitDstStageMask = &waitAt,
                            .commandBufferCount = 1,
                            .pCommandBuffers = &commands_,
                            .signalSemaphoreCount = 1,
                            .pSignalSemaphores = &drawn};
  const VkFence done = done_.get();
  check(vkQueueSubmit(device_.queue(), 1, &submit, done), "vkQueueSubmit");
  const VkSwapchainKHR swapchain = swapchain_->handle();
  const VkPresentInfoKHR info{.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR,
                              .waitSemaphoreCount = 1,
                              .pWaitSemaphores = &drawn,
                              .swapchainCount = 1,
                              .pSwapchains = &swapchain,
                              .pImageIndices = &index};
  const VkResult presented = vkQueuePresentKHR(device_.queue(), &info);
  check(vkWaitForFences(device_.handle(), 1, &done, VK_TRUE, UINT64_MAX), "vkWaitForFences");
  check(vkResetFences(device_.handle(), 1, &done), "vkResetFences");
  if (presented == VK_ERROR_OUT_OF_DATE_KHR) return false;
  check(presented, "vkQueuePresentKHR");
  return presented == VK_SUCCESS;
}

Image Presenter::kept() const {
  const size_t count = size_t{keptExtent_.width} * keptExtent_.height;
  if (count == 0) throw Error("no frame was kept");
  void* mapped = nullptr;
  check(vkMapMemory(device_.handle(), keptPixels_.memory.get(), 0, VK_WHOLE_SIZE, 0, &mapped), "vkMapMemory");
  std::vector<unsigned char> bytes(4 * count);
  std::memcpy(bytes.data(), mapped, bytes.size());
  vkUnmapMemory(device_.handle(), keptPixels_.memory.get());

  const bool blueFirst = format_.format == VK_FORMAT_B8G8R8A8_UNORM;
  Image image{.width = keptExtent_.width, .height = keptExtent_.height};
  for (const size_t channel : {0u, 1u, 2u}) {
    const size_t byte = blueFirst ? 2 - channel : channel;
    std::vector<float> values(count);
    for (size_t i = 0; i < count; ++i) values[i] = static_cast<float>(bytes[4 * i + byte]) / 255.0f;
    image.channels.push_back({std::string(1, "RGB"[channel]), std::move(values)});
  }
  return image;
}

} // namespace isophote::viewer
