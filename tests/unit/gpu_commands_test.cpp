#include <algorithm>

#include <gtest/gtest.h>

#include "gpu/commands.hpp"
#include "gpu/device_impl.hpp"
#include "isophote/error.hpp"
#include "support/gpu_device.hpp"
#include "test_unit_kernels.hpp"
#include "unit/gpu_case.h"
#include "unit/gpu_own_device.hpp"

using namespace isophote;
using gpu::Buffer;
using gpu::CommandStream;
using gpu::CounterArgs;
using gpu::Kernel;
using gpu::Memory;

namespace {

constexpr uint32_t kWorkgroup = 32;

Kernel counterKernel(const Device& device) {
  const gpu::SpecConstant size{0, kWorkgroup};
  return Kernel(device, test_unit_kernels::kernelSource("gpu_counter"), std::span(&size, 1), VK_NULL_HANDLE,
                sizeof(CounterArgs));
}

std::vector<uint32_t> contents(const Device& device, const Buffer& buffer) {
  std::vector<uint32_t> words(buffer.bytes() / sizeof(uint32_t));
  gpu::readBuffer(device, buffer, 0, std::as_writable_bytes(std::span(words)));
  return words;
}

/// A stream, a kernel and two zeroed counters on a given device.
struct Counting {
  explicit Counting(const Device& owner, uint32_t maxDispatches = 4)
      : device(owner), kernel(counterKernel(owner)),
        counters(gpu::uploadBuffer(owner, std::vector<uint32_t>{0, 0}, "c")), commands(owner, maxDispatches, "test") {}

  void dispatch(uint32_t groups, uint32_t index = 0, uint32_t rounds = 1) {
    const CounterArgs args{counters.address(), index, rounds};
    commands.dispatch(kernel, &args, sizeof(args), VK_NULL_HANDLE, groups);
  }

  const Device& device;
  Kernel kernel;
  Buffer counters;
  CommandStream commands;
};

} // namespace

TEST(CommandStream, DispatchRunsEveryInvocationOnce) {
  Counting run(test::gpuDevice());
  run.commands.begin();
  run.dispatch(3);
  run.dispatch(2, 1);
  run.commands.submitAndWait();
  EXPECT_EQ(contents(run.device, run.counters), (std::vector<uint32_t>{3 * kWorkgroup, 2 * kWorkgroup}));
}

TEST(CommandStream, IndirectDispatchReadsItsSizeOnTheDevice) {
  Counting run(test::gpuDevice());
  const Buffer arguments =
      gpu::uploadBuffer(run.device, std::vector<uint32_t>{9, 9, 9, 5, 1, 1, 0, 1, 1}, "test.sizes");
  run.commands.begin();
  for (const uint32_t entry : {1u, 2u}) {
    const CounterArgs args{run.counters.address(), entry - 1, 1};
    run.commands.dispatchIndirect(run.kernel, &args, sizeof(args), VK_NULL_HANDLE, arguments,
                                  entry * sizeof(VkDispatchIndirectCommand));
  }
  run.commands.submitAndWait();
  EXPECT_EQ(contents(run.device, run.counters), (std::vector<uint32_t>{5 * kWorkgroup, 0}));
}

TEST(CommandStream, ADispatchSeesWhatTheOneBeforeWroteAsItsSize) {
  Counting run(test::gpuDevice());
  // The first kernel counts 32 into the x of the indirect size that the second one reads.
  const Buffer arguments = gpu::uploadBuffer(run.device, std::vector<uint32_t>{0, 1, 1}, "test.sizes");
  run.commands.begin();
  const CounterArgs makeSize{arguments.address(), 0, 1};
  run.commands.dispatch(run.kernel, &makeSize, sizeof(makeSize), VK_NULL_HANDLE, 1);
  const CounterArgs count{run.counters.address(), 1, 1};
  run.commands.dispatchIndirect(run.kernel, &count, sizeof(count), VK_NULL_HANDLE, arguments, 0);
  run.commands.submitAndWait();
  EXPECT_EQ(contents(run.device, run.counters), (std::vector<uint32_t>{0, kWorkgroup * kWorkgroup}));
}

TEST(CommandStream, FillWritesEveryWholeWordAndNothingElseMoves) {
  const Device& device = test::gpuDevice();
  const Buffer buffer(device, 4 * 5 + 3, Memory::Device, "test.fill");
  CommandStream commands(device, 1, "test");
  commands.begin();
  commands.fill(buffer, 0xabababab);
  commands.submitAndWait();
  std::vector<uint8_t> bytes(buffer.bytes());
  gpu::readBuffer(device, buffer, 0, std::as_writable_bytes(std::span(bytes)));
  EXPECT_EQ(bytes, std::vector<uint8_t>(buffer.bytes(), 0xab));
}

TEST(CommandStream, TimesAddUpOverSubmits) {
  Counting run(test::gpuDevice());
  for (int submit = 0; submit < 3; ++submit) {
    run.commands.begin();
    run.dispatch(64, 0, 100);
    run.dispatch(64, 1, 100);
    run.commands.submitAndWait();
    EXPECT_GE(run.commands.lastSubmitMilliseconds(), run.commands.lastLongestDispatchMilliseconds());
  }
  ASSERT_EQ(run.commands.times().size(), 1u);
  const gpu::KernelTime& time = run.commands.times()[0];
  EXPECT_EQ(time.name, "gpu_counter");
  EXPECT_EQ(time.dispatches, 6u);
  EXPECT_GT(time.longestMilliseconds, 0.0);
  EXPECT_LE(time.longestMilliseconds, time.milliseconds);
}

// The shortest of some, because a busy machine interrupts any of them.
TEST(CommandStream, LongerWorkTakesLongerByItsTimestamps) {
  Counting run(test::gpuDevice());
  const auto milliseconds = [&](uint32_t rounds) {
    run.commands.begin();
    run.dispatch(4, 0, rounds);
    run.commands.submitAndWait();
    return run.commands.lastLongestDispatchMilliseconds();
  };
  double brief = milliseconds(1), lengthy = milliseconds(1u << 14);
  for (int i = 0; i < 10; ++i) {
    brief = std::min(brief, milliseconds(1));
    lengthy = std::min(lengthy, milliseconds(1u << 14));
  }
  EXPECT_GT(lengthy, 2 * brief);
}

TEST(CommandStream, AnEmptySubmitIsHarmless) {
  CommandStream commands(test::gpuDevice(), 0, "test");
  commands.begin();
  commands.submitAndWait();
  EXPECT_EQ(commands.lastSubmitMilliseconds(), 0.0);
}

TEST(CommandStream, MisuseIsRefusedBeforeItReachesTheDriver) {
  Counting run(test::gpuDevice(), 1);
  const CounterArgs args{run.counters.address(), 0, 1};
  run.commands.begin();
  EXPECT_THROW(run.commands.dispatch(run.kernel, &args, sizeof(args) - 4, VK_NULL_HANDLE, 1), Error);
  EXPECT_THROW(run.commands.dispatchIndirect(run.kernel, &args, sizeof(args), VK_NULL_HANDLE, run.counters, 0), Error);
  const uint32_t limit = run.device.impl().limits.maxComputeWorkGroupCount[0];
  if (limit < 0xffffffffu) {
    EXPECT_THROW(run.dispatch(limit + 1), LimitError);
  }
  run.dispatch(1);
  EXPECT_THROW(run.dispatch(1), Error) << "more dispatches than the stream was made for";
  run.commands.submitAndWait();
  EXPECT_EQ(contents(run.device, run.counters)[0], kWorkgroup);
}

TEST(CommandStream, MovesWithItsTimes) {
  Counting run(test::gpuDevice());
  run.commands.begin();
  run.dispatch(1);
  run.commands.submitAndWait();
  CommandStream moved(std::move(run.commands));
  EXPECT_EQ(moved.times().size(), 1u);
  run.commands = std::move(moved);
  run.commands.begin();
  run.dispatch(1);
  run.commands.submitAndWait();
  EXPECT_EQ(run.commands.times()[0].dispatches, 2u);
}

TEST(SynchronizationValidation, SeesAPlantedHazard) {
  const Device& device = test::gpuDevice();
  const Buffer buffer(device, 64, Memory::Device, "test.hazard");
  CommandStream commands(device, 1, "test");
  commands.begin();
  vkCmdFillBuffer(commands.handle(), buffer.handle(), 0, VK_WHOLE_SIZE, 1);
  vkCmdFillBuffer(commands.handle(), buffer.handle(), 0, VK_WHOLE_SIZE, 2); // no barrier in between
  commands.submitAndWait();
  const auto messages = test::takeValidationMessages();
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_NE(messages[0].find("SYNC-HAZARD-WRITE-AFTER-WRITE"), std::string::npos) << messages[0];
  EXPECT_NE(messages[0].find("test.hazard"), std::string::npos) << "objects are named: " << messages[0];
}

TEST(DeviceLoss, NoAnswerInTimeIsADeviceErrorAndEndsAllSubmits) {
  test::OwnDevice own;
  {
    Counting run(own.device);
    run.commands.begin();
    run.dispatch(4096, 0, 1u << 9); // about 0.2 s on a processor, 100 us on a fast GPU
    EXPECT_THROW(run.commands.submitAndWait(1e-6), DeviceError);
    vkDeviceWaitIdle(own.device.handle());
    run.commands.begin();
    run.dispatch(1);
    EXPECT_THROW(run.commands.submitAndWait(), DeviceError);
  }
  EXPECT_EQ(own.takeMessages(), std::vector<std::string>{});
}
