// A machine whose devices have no ray query: what --backend ray-query says there, and that nothing else minds.
#include <cstring>

#include <dlfcn.h>
#include <gtest/gtest.h>

#include "isophote/device.hpp"
#include "isophote/error.hpp"

namespace {

bool hidden = false; // whether devices seem to lack VK_KHR_ray_query

struct HiddenRayQuery {
  HiddenRayQuery() { hidden = true; }
  ~HiddenRayQuery() { hidden = false; }
};

} // namespace

// Stands before the loader's function of this name, for this executable.
extern "C" VKAPI_ATTR VkResult VKAPI_CALL vkEnumerateDeviceExtensionProperties(VkPhysicalDevice device,
                                                                               const char* layer, uint32_t* count,
                                                                               VkExtensionProperties* extensions) {
  static const auto real = reinterpret_cast<PFN_vkEnumerateDeviceExtensionProperties>(
      dlsym(RTLD_NEXT, "vkEnumerateDeviceExtensionProperties"));
  const VkResult result = real(device, layer, count, extensions);
  for (uint32_t i = 0; hidden && extensions != nullptr && i < *count; ++i) {
    if (std::strcmp(extensions[i].extensionName, VK_KHR_RAY_QUERY_EXTENSION_NAME) == 0)
      std::strcpy(extensions[i].extensionName, "VK_TEST_hidden");
  }
  return result;
}

TEST(RayQueryDevice, WhereNoneHasItTheRefusalSaysWhatIsMissing) {
  const HiddenRayQuery hide;
  const isophote::VulkanInstance instance;
  for (const isophote::DeviceInfo& info : instance.devices()) EXPECT_FALSE(info.rayQuery);
  EXPECT_NO_THROW(isophote::Device(instance, {.selector = ""}));
  try {
    const isophote::Device device(instance, {.rayQuery = true});
    FAIL();
  } catch (const isophote::DeviceError& error) {
    EXPECT_NE(std::string(error.what()).find("lacks VK_KHR_ray_query"), std::string::npos) << error.what();
  }
}
