#include <gtest/gtest.h>

#include <random>

#include "gpu/buffer.hpp"
#include "gpu/device_impl.hpp"
#include "isophote/error.hpp"
#include "support/gpu_device.hpp"
#include "unit/gpu_own_device.hpp"

using namespace isophote;
using gpu::Buffer;
using gpu::Memory;

namespace {

std::vector<std::byte> randomBytes(size_t count) {
  std::mt19937 generator(1);
  std::vector<std::byte> bytes(count);
  for (auto& byte : bytes) byte = static_cast<std::byte>(generator());
  return bytes;
}

void expectRoundTrip(const Device& device, Memory memory, size_t count) {
  const auto written = randomBytes(count);
  const Buffer buffer(device, count, memory, "test.roundTrip");
  gpu::writeBuffer(device, buffer, 0, written);
  std::vector<std::byte> read(count);
  gpu::readBuffer(device, buffer, 0, read);
  EXPECT_TRUE(read == written) << count << " bytes";
}

std::string limitMessage(const Device& device, uint64_t bytes) {
  try {
    const Buffer buffer(device, bytes, Memory::Device, "test.huge");
  } catch (const LimitError& error) {
    return error.what();
  }
  return "no LimitError";
}

constexpr size_t kBeyondStaging = (16u << 20) * 2 + 5;

} // namespace

TEST(Buffer, BytesOfAnyCountComeBack) {
  for (const size_t count : {size_t{1}, size_t{3}, size_t{4}, size_t{4097}, kBeyondStaging}) {
    expectRoundTrip(test::gpuDevice(), Memory::Device, count);
  }
  expectRoundTrip(test::gpuDevice(), Memory::Host, 4097);
}

TEST(Buffer, BytesOfAnyCountComeBackThroughStaging) {
  test::OwnDevice own;
  own.device.impl().unifiedMemory = false; // as on a discrete device
  for (const size_t count : {size_t{1}, size_t{3}, size_t{4097}, kBeyondStaging}) {
    expectRoundTrip(own.device, Memory::Device, count);
  }
  EXPECT_EQ(own.takeMessages(), std::vector<std::string>{});
}

TEST(Buffer, AWriteAtAnOffsetChangesNothingElse) {
  for (const bool unified : {true, false}) {
    test::OwnDevice own;
    own.device.impl().unifiedMemory = unified;
    const std::vector<uint8_t> zeros(64, 0);
    const Buffer buffer = gpu::uploadBuffer(own.device, zeros, "test.offset");
    const std::vector<uint8_t> part{1, 2, 3};
    gpu::writeBuffer(own.device, buffer, 7, std::as_bytes(std::span(part)));
    std::vector<uint8_t> expected = zeros;
    std::copy(part.begin(), part.end(), expected.begin() + 7);
    std::vector<uint8_t> read(64);
    gpu::readBuffer(own.device, buffer, 0, std::as_writable_bytes(std::span(read)));
    EXPECT_EQ(read, expected);
    std::vector<uint8_t> middle(2);
    gpu::readBuffer(own.device, buffer, 8, std::as_writable_bytes(std::span(middle)));
    EXPECT_EQ(middle, (std::vector<uint8_t>{2, 3}));
    EXPECT_EQ(own.takeMessages(), std::vector<std::string>{});
  }
}

TEST(Buffer, OnlyHostMemoryIsMapped) {
  const Buffer host(test::gpuDevice(), 16, Memory::Host, "test.host");
  const Buffer device(test::gpuDevice(), 16, Memory::Device, "test.device");
  EXPECT_NE(host.mapped(), nullptr);
  EXPECT_EQ(device.mapped(), nullptr);
}

TEST(Buffer, SizeZeroIsANullBuffer) {
  const Buffer buffer = gpu::uploadBuffer(test::gpuDevice(), std::vector<float>{}, "test.empty");
  EXPECT_EQ(buffer.handle(), VkBuffer(VK_NULL_HANDLE));
  EXPECT_EQ(buffer.address(), 0u);
  EXPECT_EQ(buffer.bytes(), 0u);
  gpu::writeBuffer(test::gpuDevice(), buffer, 0, {});
}

TEST(Buffer, AccessOutsideIsRefused) {
  const Buffer buffer(test::gpuDevice(), 16, Memory::Device, "test.small");
  std::vector<std::byte> bytes(8);
  EXPECT_THROW(gpu::writeBuffer(test::gpuDevice(), buffer, 9, bytes), Error);
  EXPECT_THROW(gpu::readBuffer(test::gpuDevice(), buffer, 9, bytes), Error);
  EXPECT_THROW(gpu::readBuffer(test::gpuDevice(), buffer, ~0ull, bytes), Error);
  EXPECT_NO_THROW(gpu::readBuffer(test::gpuDevice(), buffer, 8, bytes));
}

TEST(Buffer, TooLargeForTheDeviceNamesTheBufferAndTheFigures) {
  const uint64_t bytes = 1ull << 60;
  const std::string message = limitMessage(test::gpuDevice(), bytes);
  EXPECT_NE(message.find("test.huge needs " + std::to_string(bytes) + " bytes"), std::string::npos) << message;
  EXPECT_NE(message.find(std::to_string(test::gpuDevice().impl().maxBufferBytes)), std::string::npos) << message;
}

TEST(Buffer, MoreThanIsAvailableIsRefusedBeforeItIsAllocated) {
  test::OwnDevice own;
  Device::Impl& impl = own.device.impl();
  impl.memoryBudget = false; // so that what is available is known here: the heap less the 1 MiB below
  impl.memory.memoryHeaps[0].size = 4u << 20;
  for (uint32_t i = 1; i < impl.memory.memoryHeapCount; ++i) impl.memory.memoryHeaps[i].size = 4u << 20;
  const Buffer first(own.device, 1u << 20, Memory::Device, "test.first");
  const std::string message = limitMessage(own.device, 8u << 20);
  EXPECT_NE(message.find("test.huge needs "), std::string::npos) << message;
  const uint64_t available = (4u << 20) - own.device.allocatedBytes();
  EXPECT_NE(message.find(std::to_string(available) + " are available"), std::string::npos) << message;
  EXPECT_EQ(own.device.allocatedBytes(), (4u << 20) - available);
}

TEST(Buffer, TheDeviceAccountsForEveryByteAndGetsItBack) {
  const Device& device = test::gpuDevice();
  const uint64_t before = device.allocatedBytes();
  {
    const Buffer buffer(device, 1000, Memory::Device, "test.account");
    EXPECT_GE(device.allocatedBytes(), before + 1000);
  }
  EXPECT_EQ(device.allocatedBytes(), before);
  EXPECT_NE(limitMessage(device, 1ull << 60), "no LimitError");
  EXPECT_EQ(device.allocatedBytes(), before);
}

TEST(Buffer, MoveLeavesANullBuffer) {
  const Device& device = test::gpuDevice();
  const uint64_t before = device.allocatedBytes();
  {
    Buffer first(device, 64, Memory::Host, "test.first");
    const uint64_t address = first.address();
    Buffer second(std::move(first));
    EXPECT_EQ(second.address(), address);
    EXPECT_EQ(first.address(), 0u);
    EXPECT_EQ(first.handle(), VkBuffer(VK_NULL_HANDLE));
    EXPECT_EQ(first.mapped(), nullptr);
    Buffer third(device, 128, Memory::Host, "test.third");
    third = std::move(second);
    EXPECT_EQ(third.address(), address);
    EXPECT_EQ(third.bytes(), 64u);
    EXPECT_EQ(third.name(), "test.first");
    Buffer& alias = third;
    third = std::move(alias);
    EXPECT_EQ(third.address(), address) << "after moving a buffer to itself";
  }
  EXPECT_EQ(device.allocatedBytes(), before);
}
