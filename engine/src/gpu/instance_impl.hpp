// What a VulkanInstance owns.
#pragma once

#include "isophote/device.hpp"

#include "gpu/validation.hpp"

namespace isophote {

struct VulkanInstance::Impl {
  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl();

  gpu::ValidationSink sink; ///< before the instance: it must outlive the messenger
  VkInstance handle = VK_NULL_HANDLE;
  VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
  bool debugUtils = false; ///< names and regions can be set
};

} // namespace isophote
