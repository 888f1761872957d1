// Every Vulkan call of a render that can fail, fails once (bad inputs 34 and 35).
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

/// As a render of its own: with a device that was made for it.
void renderFromScratch(const Scene& scene, std::vector<std::string>& messages) {
  const OwnDevice own;
  struct Collect { // also where the render throws
    const OwnDevice& own;
    std::vector<std::string>& messages;
    ~Collect() { messages = own.instance.validationMessages(); }
  } collect{own, messages};
  (void)render(own.device, scene);
}

uint64_t callsOf(const Scene& scene) {
  std::vector<std::string> messages;
  fault::armVulkan(0);
  renderFromScratch(scene, messages);
  EXPECT_TRUE(messages.empty());
  return fault::vulkanFaults().calls;
}

void expectRefusedAndNothingLeft(const Scene& scene, uint64_t nth) {
  SCOPED_TRACE(testing::Message() << "call " << nth);
  std::vector<std::string> messages;
  fault::armVulkan(nth);
  std::string what = "nothing was thrown";
  bool limit = false, device = false;
  try {
    renderFromScratch(scene, messages);
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
  EXPECT_EQ(messages, std::vector<std::string>{}) << faults.failed;
  EXPECT_EQ(what.find('\n'), std::string::npos) << what;
}

void sweep(uint64_t first, uint64_t step) {
  const Scene scene = everything();
  const uint64_t calls = callsOf(scene);
  EXPECT_GT(calls, 100u);
  testing::Test::RecordProperty("calls", static_cast<int>(calls));
  for (uint64_t nth = first; nth <= calls; nth += step) expectRefusedAndNothingLeft(scene, nth);
}

TEST(VulkanFault, EveryFortiethCallThatFailsEndsTheRenderCleanly) { sweep(5, 40); }

TEST(VulkanFault, EveryCallThatFailsEndsTheRenderCleanlySlow) { sweep(1, 1); }

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
