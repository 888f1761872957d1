#include "viewer/swapchain.hpp"

#include <algorithm>

#include "isophote/error.hpp"
#include "viewer/vulkan_objects.hpp"

namespace isophote::viewer {
namespace {

constexpr VkImageUsageFlags kUsage =
    VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;

// Newest frame first where there is the choice, so that a drag is not behind a queue of old frames.
VkPresentModeKHR choosePresentMode(const Device& device, VkSurfaceKHR surface) {
  uint32_t count = 0;
  check(vkGetPhysicalDeviceSurfacePresentModesKHR(device.physical(), surface, &count, nullptr), "present modes");
  std::vector<VkPresentModeKHR> modes(count);
  check(vkGetPhysicalDeviceSurfacePresentModesKHR(device.physical(), surface, &count, modes.data()), "present modes");
  const bool mailbox = std::find(modes.begin(), modes.end(), VK_PRESENT_MODE_MAILBOX_KHR) != modes.end();
  return mailbox ? VK_PRESENT_MODE_MAILBOX_KHR : VK_PRESENT_MODE_FIFO_KHR;
}

VkExtent2D chooseExtent(const VkSurfaceCapabilitiesKHR& can, VkExtent2D wanted) {
  if (can.currentExtent.width != 0xffffffffu) return can.currentExtent;
  return {std::clamp(wanted.width, can.minImageExtent.width, can.maxImageExtent.width),
          std::clamp(wanted.height, can.minImageExtent.height, can.maxImageExtent.height)};
}

UniqueHandle<VkImageView> makeView(const Device& device, VkImage image, VkFormat format) {
  const VkImageViewCreateInfo info{.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                   .image = image,
                                   .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                   .format = format,
                                   .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
  VkImageView view = VK_NULL_HANDLE;
  check(vkCreateImageView(device.handle(), &info, nullptr, &view), "vkCreateImageView");
  return {device.handle(), view, vkDestroyImageView};
}

UniqueHandle<VkFramebuffer> makeFramebuffer(const Device& device, VkRenderPass pass, VkImageView view,
                                            VkExtent2D extent) {
  const VkFramebufferCreateInfo info{.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                     .renderPass = pass,
                                     .attachmentCount = 1,
                                     .pAttachments = &view,
                                     .width = extent.width,
                                     .height = extent.height,
                                     .layers = 1};
  VkFramebuffer framebuffer = VK_NULL_HANDLE;
  check(vkCreateFramebuffer(device.handle(), &info, nullptr, &framebuffer), "vkCreateFramebuffer");
  return {device.handle(), framebuffer, vkDestroyFramebuffer};
}

} // namespace

VkSurfaceFormatKHR chooseFormat(const Device& device, VkSurfaceKHR surface) {
  uint32_t count = 0;
  check(vkGetPhysicalDeviceSurfaceFormatsKHR(device.physical(), surface, &count, nullptr), "surface formats");
  std::vector<VkSurfaceFormatKHR> formats(count);
  check(vkGetPhysicalDeviceSurfaceFormatsKHR(device.physical(), surface, &count, formats.data()), "surface formats");
  for (const VkFormat wanted : {VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM}) {
    for (const VkSurfaceFormatKHR& format : formats) {
      if (format.format == wanted && format.colorSpace == VK_COLOR_SPACE_SRGB_NONLINEAR_KHR) return format;
    }
  }
  throw DeviceError(device.info().name + ": the window offers no 8-bit UNORM format");
}

Swapchain::Swapchain(const Device& device, VkSurfaceKHR surface, VkExtent2D wanted, VkSurfaceFormatKHR format,
                     VkRenderPass renderPass, VkSwapchainKHR old) {
  VkSurfaceCapabilitiesKHR can{};
  check(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device.physical(), surface, &can), "surface capabilities");
  if ((can.supportedUsageFlags & kUsage) != kUsage) {
    throw DeviceError(device.info().name + ": the window's images cannot be copied to and from");
  }
  extent_ = chooseExtent(can, wanted);
  const uint32_t fewest = std::max(can.minImageCount, 2u) + 1;
  const VkSwapchainCreateInfoKHR info{.sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR,
                                      .surface = surface,
                                      .minImageCount =
                                          can.maxImageCount != 0 ? std::min(fewest, can.maxImageCount) : fewest,
                                      .imageFormat = format.format,
                                      .imageColorSpace = format.colorSpace,
                                      .imageExtent = extent_,
                                      .imageArrayLayers = 1,
                                      .imageUsage = kUsage,
                                      .preTransform = can.currentTransform,
                                      .compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR,
                                      .presentMode = choosePresentMode(device, surface),
                                      .clipped = VK_FALSE, // a screenshot reads pixels that another window may cover
                                      .oldSwapchain = old};
  VkSwapchainKHR handle = VK_NULL_HANDLE;
  check(vkCreateSwapchainKHR(device.handle(), &info, nullptr, &handle), "vkCreateSwapchainKHR");
  handle_ = {device.handle(), handle, vkDestroySwapchainKHR};

  uint32_t count = 0;
  check(vkGetSwapchainImagesKHR(device.handle(), handle, &count, nullptr), "vkGetSwapchainImagesKHR");
  images_.resize(count);
  check(vkGetSwapchainImagesKHR(device.handle(), handle, &count, images_.data()), "vkGetSwapchainImagesKHR");
  for (const VkImage image : images_) {
    views_.push_back(makeView(device, image, format.format));
    framebuffers_.push_back(makeFramebuffer(device, renderPass, views_.back().get(), extent_));
    drawn_.push_back(makeSemaphore(device));
  }
}

} // namespace isophote::viewer
