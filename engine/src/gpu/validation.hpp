// Where the validation layer's messages go.
#pragma once

#include <mutex>
#include <string>
#include <vector>

#include <vulkan/vulkan.h>

namespace isophote::gpu {

/// Collects messages from any thread.
class ValidationSink {
public:
  void add(std::string message);
  [[nodiscard]] std::vector<std::string> messages() const;
  void clear();

private:
  mutable std::mutex mutex_;
  std::vector<std::string> messages_;
};

/// A messenger that appends the layer's warnings and errors to `sink`, which must outlive it. No other message type is
/// taken: the loader's own complaints about unrelated drivers say nothing about this program.
[[nodiscard]] VkDebugUtilsMessengerCreateInfoEXT messengerInfo(ValidationSink& sink);

} // namespace isophote::gpu
