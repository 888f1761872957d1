#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "gpu/buffer.hpp"
#include "gpu/device_impl.hpp"
#include "gpu/physical_devices.hpp"
#include "gpu/vulkan_check.hpp"
#include "isophote/error.hpp"
#include "support/cache_folder.hpp"
#include "support/gpu_device.hpp"
#include "support/scoped_variable.hpp"
#include "unit/gpu_own_device.hpp"

using namespace isophote;

namespace {

gpu::PhysicalDevice made(uint32_t index, const char* name, const char* kind, const char* rejection) {
  return {.info = {.index = index, .name = name, .kind = kind, .rejection = rejection}};
}

const std::vector<gpu::PhysicalDevice> kMadeDevices{
    made(0, "llvmpipe (LLVM)", "cpu", ""), made(1, "Slow Graphics 600", "integrated", ""),
    made(2, "Old Card", "discrete", "Vulkan 1.3 (it has 1.1.0)"), made(3, "Fast Card A", "discrete", ""),
    made(4, "Fast Card B", "discrete", "")};

std::string selected(const std::string& selector) {
  return gpu::selectPhysicalDevice(kMadeDevices, selector).info.name;
}

template <class Action> std::string deviceError(Action action) {
  try {
    action();
  } catch (const DeviceError& error) {
    return error.what();
  }
  return "no DeviceError";
}

} // namespace

TEST(DeviceSelection, TakesTheFastestUsableKind) { EXPECT_EQ(selected(""), "Fast Card A"); }

TEST(DeviceSelection, TakesAnIndexANamePartOrCpu) {
  EXPECT_EQ(selected("4"), "Fast Card B");
  EXPECT_EQ(selected("fast card b"), "Fast Card B");
  EXPECT_EQ(selected("GRAPHICS"), "Slow Graphics 600");
  EXPECT_EQ(selected("cpu"), "llvmpipe (LLVM)");
  EXPECT_THROW((void)selected("600"), DeviceError) << "a number is an index, never a name part";
}

TEST(DeviceSelection, RefusalListsEveryDeviceWithItsReason) {
  const std::string message = deviceError([] { (void)selected("old"); });
  EXPECT_NE(message.find("no usable device matches 'old'"), std::string::npos) << message;
  EXPECT_NE(message.find("2: Old Card (discrete): lacks Vulkan 1.3 (it has 1.1.0)"), std::string::npos) << message;
  for (const auto& device : kMadeDevices) EXPECT_NE(message.find(device.info.name), std::string::npos) << message;
}

TEST(DeviceSelection, NoDeviceAtAllSaysSo) {
  const std::string message = deviceError([] { (void)gpu::selectPhysicalDevice({}, ""); });
  EXPECT_NE(message.find("found none"), std::string::npos) << message;
}

TEST(Device, AnUnknownNameIsRefusedWithTheDevicesOfThisMachine) {
  const VulkanInstance instance;
  const std::string message = deviceError([&] { const Device device(instance, {.selector = "no such device"}); });
  for (const auto& info : instance.devices()) EXPECT_NE(message.find(info.name), std::string::npos) << message;
}

TEST(Device, DescribesItself) {
  const DeviceInfo& info = test::gpuDevice().info();
  EXPECT_FALSE(info.name.empty());
  EXPECT_FALSE(info.driver.empty());
  EXPECT_GT(info.subgroupSize, 0u);
  EXPECT_GT(info.memoryBytes, 0u);
  EXPECT_EQ(info.rejection, "");
  EXPECT_GT(test::gpuDevice().timestampNanoseconds(), 0.0);
  EXPECT_EQ(test::gpuDevice().isCpu(), info.kind == "cpu");
}

TEST(Device, MayMoveWhileItsBuffersLive) {
  test::OwnDevice own;
  const gpu::Buffer buffer = gpu::uploadBuffer(own.device, std::vector<uint32_t>{1, 2, 3}, "test.survivor");
  Device moved(std::move(own.device));
  std::vector<uint32_t> read(3);
  gpu::readBuffer(moved, buffer, 0, std::as_writable_bytes(std::span(read)));
  EXPECT_EQ(read, (std::vector<uint32_t>{1, 2, 3}));
  own.device = std::move(moved); // so that the buffer goes before the device
  EXPECT_EQ(own.takeMessages(), std::vector<std::string>{});
}

TEST(VulkanInstance, ValidationWithoutItsLayerIsADeviceError) {
  const test::ScopedVariable noLayers("VK_LAYER_PATH", "/nonexistent");
  const std::string message = deviceError([] { const VulkanInstance instance({.validation = true}); });
  EXPECT_NE(message.find("VK_LAYER_KHRONOS_validation"), std::string::npos) << message;
}

TEST(VulkanInstance, NoDriverIsADeviceErrorWithAHint) {
  const test::ScopedVariable noDrivers("VK_DRIVER_FILES", "/nonexistent.json");
  const std::string message = deviceError([] {
    const VulkanInstance instance;
    const Device device(instance);
  });
  EXPECT_NE(message.find("lavapipe"), std::string::npos) << message;
}

TEST(VulkanInstance, CollectsWhatTheValidationLayerSays) {
  test::OwnDevice own;
  EXPECT_EQ(own.takeMessages(), std::vector<std::string>{});
  VkBuffer buffer = VK_NULL_HANDLE;
  const VkBufferCreateInfo info{.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = 0, .usage = 0};
  vkCreateBuffer(own.device.handle(), &info, nullptr, &buffer);
  const auto messages = own.takeMessages();
  EXPECT_FALSE(messages.empty());
  EXPECT_EQ(own.takeMessages(), std::vector<std::string>{}) << "clearing forgets";
  if (buffer) vkDestroyBuffer(own.device.handle(), buffer, nullptr);
}

TEST(VulkanCheck, MemoryIsALimitAndAllElseADeviceError) {
  EXPECT_NO_THROW(gpu::check(VK_SUCCESS, "call"));
  EXPECT_NO_THROW(gpu::check(VK_INCOMPLETE, "call"));
  EXPECT_THROW(gpu::check(VK_ERROR_OUT_OF_DEVICE_MEMORY, "call"), LimitError);
  EXPECT_THROW(gpu::check(VK_ERROR_OUT_OF_HOST_MEMORY, "call"), LimitError);
  const std::string message = deviceError([] { gpu::check(VK_ERROR_INITIALIZATION_FAILED, "vkSomeCall"); });
  EXPECT_EQ(message, "vkSomeCall failed with VK_ERROR_INITIALIZATION_FAILED (-3)");
}

TEST(PipelineCache, IsSavedInTheUsersCacheFolderWithoutLeftovers) {
  const test::CacheFolder folder;
  { test::OwnDevice own; }
  const auto files = folder.files();
  ASSERT_EQ(files.size(), 1u);
  EXPECT_EQ(files[0].extension(), ".bin");
  EXPECT_GE(std::filesystem::file_size(files[0]), sizeof(VkPipelineCacheHeaderVersionOne));
}

TEST(PipelineCache, AForeignFileIsReplaced) {
  const test::CacheFolder folder;
  { test::OwnDevice own; }
  const auto file = folder.files().at(0);
  const auto bytes = std::filesystem::file_size(file);
  std::ofstream(file, std::ios::binary | std::ios::trunc) << std::string(1000, 'x');
  {
    test::OwnDevice own;
    EXPECT_EQ(own.takeMessages(), std::vector<std::string>{});
  }
  EXPECT_EQ(std::filesystem::file_size(file), bytes);
}

TEST(PipelineCache, AFolderThatCannotBeWrittenChangesNothing) {
  const test::CacheFolder folder;
  std::ofstream(folder.own()) << "a file where the folder should be";
  EXPECT_NO_THROW({ test::OwnDevice own; });
  EXPECT_TRUE(std::filesystem::is_regular_file(folder.own()));
}
