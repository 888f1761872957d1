#include "ray_query/ray_query_device.hpp"

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <string>

namespace isophote::test {
namespace {

struct RayQueryGpu {
  VulkanInstance instance{{.validation = true}};
  Device device{instance, {.selector = selector(), .rayQuery = true}};

  static std::string selector() {
    const char* text = std::getenv("ISOPHOTE_TEST_DEVICE");
    return text ? text : "";
  }
};

std::unique_ptr<RayQueryGpu>& gpu() {
  static std::unique_ptr<RayQueryGpu> shared;
  return shared;
}

bool isOffered() {
  const auto devices = VulkanInstance().devices();
  return std::any_of(devices.begin(), devices.end(), [](const DeviceInfo& info) { return info.rayQuery; });
}

/// Destroys the device while the loader still works.
class RayQueryEnvironment : public testing::Environment {
  void TearDown() override { gpu().reset(); }
};
[[maybe_unused]] const auto* const kEnvironment = testing::AddGlobalTestEnvironment(new RayQueryEnvironment);

} // namespace

void RayQueryTest::SetUp() {
  if (!gpu() && !isOffered()) GTEST_SKIP() << "no device here has VK_KHR_ray_query";
}

void RayQueryTest::TearDown() {
  if (!gpu()) return;
  for (const std::string& message : gpu()->instance.validationMessages()) ADD_FAILURE() << message;
  gpu()->instance.clearValidationMessages();
}

const Device& RayQueryTest::device() {
  if (!gpu()) gpu() = std::make_unique<RayQueryGpu>();
  return gpu()->device;
}

} // namespace isophote::test
