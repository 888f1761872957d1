// A device of a test's own, for tests that change or break it.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "isophote/device.hpp"
#include "support/gpu_device.hpp"

namespace isophote::test {

struct OwnDevice {
  OwnDevice()
      : instance({.validation = true}), device(instance, {.selector = std::to_string(gpuDevice().info().index)}) {}

  [[nodiscard]] std::vector<std::string> takeMessages() {
    auto messages = instance.validationMessages();
    instance.clearValidationMessages();
    return messages;
  }

  VulkanInstance instance;
  Device device;
};

} // namespace isophote::test
