#include "support/gpu_device.hpp"

#include <cstdlib>
#include <memory>
#include <optional>

namespace isophote::test {
namespace {

struct SharedGpu {
  SharedGpu()
      : instance({.validation = true}), device(std::in_place, instance, DeviceOptions{.selector = selector()}) {}

  static std::string selector() {
    const char* text = std::getenv("ISOPHOTE_TEST_DEVICE");
    return text ? text : "";
  }

  VulkanInstance instance;
  std::optional<Device> device;
};

std::unique_ptr<SharedGpu>& sharedGpu() {
  static std::unique_ptr<SharedGpu> gpu;
  return gpu;
}

} // namespace

const Device& gpuDevice() {
  auto& gpu = sharedGpu();
  if (!gpu) gpu = std::make_unique<SharedGpu>();
  return *gpu->device;
}

std::vector<std::string> takeValidationMessages() {
  auto& gpu = sharedGpu();
  if (!gpu) return {};
  std::vector<std::string> messages = gpu->instance.validationMessages();
  gpu->instance.clearValidationMessages();
  return messages;
}

std::vector<std::string> destroySharedGpu() {
  auto& gpu = sharedGpu();
  if (!gpu) return {};
  gpu->device.reset();
  std::vector<std::string> messages = takeValidationMessages();
  gpu.reset();
  return messages;
}

} // namespace isophote::test
