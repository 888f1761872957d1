#include "gpu/validation.hpp"

namespace isophote::gpu {
namespace {

VkBool32 VKAPI_CALL onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                              const VkDebugUtilsMessengerCallbackDataEXT* data, void* userData) noexcept {
  try {
    std::string text = data->pMessage ? data->pMessage : "";
    if (data->pMessageIdName) text = std::string(data->pMessageIdName) + ": " + text;
    static_cast<ValidationSink*>(userData)->add(std::move(text));
  } catch (...) {
    // Out of memory while reporting; an exception must not cross the C frames of the layer.
  }
  return VK_FALSE;
}

} // namespace

void ValidationSink::add(std::string message) {
  const std::lock_guard lock(mutex_);
  messages_.push_back(std::move(message));
}

std::vector<std::string> ValidationSink::messages() const {
  const std::lock_guard lock(mutex_);
  return messages_;
}

void ValidationSink::clear() {
  const std::lock_guard lock(mutex_);
  messages_.clear();
}

VkDebugUtilsMessengerCreateInfoEXT messengerInfo(ValidationSink& sink) {
  return {.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
          .messageSeverity =
              VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
          .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,
          .pfnUserCallback = onMessage,
          .pUserData = &sink};
}

} // namespace isophote::gpu
