// Every Vulkan call of a render that can fail, fails once (bad inputs 34 and 35).
#include <map>

#include <gtest/gtest.h>

#include "fault/vulkan_faults.hpp"
#include "gpu/device_impl.hpp"
#include "isophote/error.hpp"
#include "isophote/path_tracer.hpp"
#include "support/scenes.hpp"
#include "unit/gpu_own_device.hpp"

namespace isophote {
namespace {

using namespace isophote::test;

/// What a render can need: textures, lights of both kinds, a medium.
Scene everything() {
  Scene scene = texturedStillLife();
  Material fog = glass(0, 1);
  fog.volume.attenuationColor = glm::vec3(0.5f);
  fog.volume.attenuationDistance = 1;
  fog.volume.multiscatterColor = glm::vec3(0.5f);
  addPrimitive(scene, box({-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2}, false, addMaterial(scene, fog)));
  return scene;
}

Image render(const Device& device, const Scene& scene) {
  const GpuScene gpuScene(device, scene);
  Film film(device, {.width = 4, .height = 4});
  PathTracer tracer(device, gpuScene);
  tracer.render(texturedStillLifeCamera(), film, {0, 8});
  return film.resolve();
}

/// Renders with a device of its own, which has gone when this returns or throws: what is left of it is a message.
void renderFromScratch(const VulkanInstance& instance, const Scene& scene) {
  const Device device(instance, {.selector = std::to_string(gpuDevice().info().index)});
  (void)render(device, scene);
}

std::vector<std::string> callsOf(const Scene& scene) {
  const VulkanInstance instance({.validation = true});
  fault::armVulkan(0);
  renderFromScratch(instance, scene);
  EXPECT_TRUE(instance.validationMessages().empty());
  return fault::vulkanFaults().calls;
}

void expectRefusedAndNothingLeft(const Scene& scene, uint64_t nth) {
  SCOPED_TRACE(testing::Message() << "call " << nth);
  const VulkanInstance instance({.validation = true});
  fault::armVulkan(nth);
  std::string what = "nothing was thrown";
  bool limit = false, device = false;
  try {
    renderFromScratch(instance, scene);
  } catch (const LimitError& error) {
    limit = true;
    what = error.what();
  } catch (const DeviceError& error) {
    device = true;
    what = error.what();
  }
  const fault::VulkanFaults faults = fault::vulkanFaults();
  fault::armVulkan(0);
  // Submits adapt to their time, so that there may be fewer calls; and a pipeline cache one can do without.
  if (faults.failed.empty() || faults.failed == "vkCreatePipelineCache") return;
  const bool lost = faults.result == VK_ERROR_DEVICE_LOST;
  EXPECT_TRUE(lost ? device : limit) << faults.failed << ": " << what;
  if (lost) {
    EXPECT_EQ(faults.submitsAfterFailed, 0u) << faults.failed;
  }
  EXPECT_EQ(instance.validationMessages(), std::vector<std::string>{}) << faults.failed;
  EXPECT_EQ(what.find('\n'), std::string::npos) << what;
}

// Of each function the call in the middle of its calls.
TEST(VulkanFault, EachFunctionThatFailsEndsTheRenderCleanly) {
  const Scene scene = everything();
  std::map<std::string, std::vector<uint64_t>> places;
  uint64_t place = 0;
  for (const std::string& function : callsOf(scene)) places[function].push_back(++place);
  EXPECT_GT(places.size(), 20u);
  for (const auto& [function, calls] : places) expectRefusedAndNothingLeft(scene, calls[calls.size() / 2]);
}

TEST(VulkanFault, EveryCallThatFailsEndsTheRenderCleanlySlow) {
  const Scene scene = everything();
  const uint64_t calls = callsOf(scene).size();
  EXPECT_GT(calls, 100u);
  for (uint64_t nth = 1; nth <= calls; ++nth) expectRefusedAndNothingLeft(scene, nth);
}

// A device that lacked memory once renders the same image afterwards, with no byte held back.
TEST(VulkanFault, ADeviceThatLackedMemoryGoesOn) {
  const OwnDevice own;
  const Scene scene = everything();
  fault::armVulkan(0);
  const Image expected = render(own.device, scene);
  const uint64_t before = own.device.impl().allocatedBytes;
  for (uint64_t nth = 3; nth < 60; nth += 25) {
    fault::armVulkan(nth);
    try {
      (void)render(own.device, scene);
    } catch (const LimitError&) {
      EXPECT_EQ(own.device.impl().allocatedBytes, before);
    } catch (const DeviceError&) {
      return; // the sweep has come to the first submit
    }
    fault::armVulkan(0);
    EXPECT_EQ(render(own.device, scene).find("R")->values, expected.find("R")->values);
  }
}

} // namespace
} // namespace isophote
