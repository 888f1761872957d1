#include "gpu/buffer.hpp"

#include "isophote/error.hpp"

#include "gpu/device_impl.hpp"
#include "gpu/memory.hpp"
#include "gpu/vulkan_check.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace isophote::gpu {
namespace {

/// Large enough to hide the cost of a submission, small beside any scene.
constexpr uint64_t kStagingBytes = 16ull << 20;

void requireInside(const Buffer& buffer, uint64_t offset, uint64_t bytes) {
  if (offset <= buffer.bytes() && bytes <= buffer.bytes() - offset) return;
  throw Error("bytes " + std::to_string(offset) + " + " + std::to_string(bytes) + " lie outside buffer " +
              buffer.name() + " of " + std::to_string(buffer.bytes()));
}

} // namespace

Buffer::Buffer(const Device& device, uint64_t bytes, Memory memory, const char* name)
    : device_(&device.impl()), bytes_(bytes), name_(name) {
  if (bytes == 0) return;
  try {
    create(memory);
  } catch (...) {
    destroy();
    throw;
  }
}

void Buffer::create(Memory memory) {
  if (bytes_ > device_->maxBufferBytes) {
    throw LimitError(name_ + " needs " + std::to_string(bytes_) + " bytes; a buffer of " + device_->info.name +
                     " holds at most " + std::to_string(device_->maxBufferBytes));
  }
  VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT |
                             VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                             VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  if (device_->acceleration) {
    usage |= VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR |
             VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR;
  }
  const VkBufferCreateInfo info{.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                .size = (bytes_ + 3) & ~3ull, // vkCmdFillBuffer writes whole words
                                .usage = usage};
  check(vkCreateBuffer(device_->handle, &info, nullptr, &buffer_), "vkCreateBuffer");
  device_->name(buffer_, VK_OBJECT_TYPE_BUFFER, name_);
  VkMemoryRequirements requirements{};
  vkGetBufferMemoryRequirements(device_->handle, buffer_, &requirements);
  const Allocation allocation = allocateMemory(*device_, requirements, memory, true, name_);
  memory_ = allocation.memory;
  memoryBytes_ = allocation.bytes;
  check(vkBindBufferMemory(device_->handle, buffer_, memory_, 0), "vkBindBufferMemory");
  if (memory == Memory::Host || (device_->unifiedMemory && allocation.hostVisible)) {
    void* pointer = nullptr;
    check(vkMapMemory(device_->handle, memory_, 0, VK_WHOLE_SIZE, 0, &pointer), "vkMapMemory");
    direct_ = static_cast<std::byte*>(pointer);
    if (memory == Memory::Host) mapped_ = pointer;
  }
  const VkBufferDeviceAddressInfo addressInfo{.sType = VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO, .buffer = buffer_};
  address_ = vkGetBufferDeviceAddress(device_->handle, &addressInfo);
}

void Buffer::destroy() noexcept {
  if (buffer_) vkDestroyBuffer(device_->handle, buffer_, nullptr);
  if (memory_) freeMemory(*device_, {memory_, memoryBytes_, false}); // unmaps
}

Buffer::Buffer(Buffer&& other) noexcept
    : device_(std::exchange(other.device_, nullptr)), buffer_(std::exchange(other.buffer_, VK_NULL_HANDLE)),
      memory_(std::exchange(other.memory_, VK_NULL_HANDLE)), memoryBytes_(std::exchange(other.memoryBytes_, 0)),
      address_(std::exchange(other.address_, 0)), bytes_(std::exchange(other.bytes_, 0)),
      mapped_(std::exchange(other.mapped_, nullptr)), direct_(std::exchange(other.direct_, nullptr)),
      name_(std::move(other.name_)) {}

Buffer& Buffer::operator=(Buffer&& other) noexcept {
  Buffer moved(std::move(other));
  std::swap(device_, moved.device_);
  std::swap(buffer_, moved.buffer_);
  std::swap(memory_, moved.memory_);
  std::swap(memoryBytes_, moved.memoryBytes_);
  std::swap(address_, moved.address_);
  std::swap(bytes_, moved.bytes_);
  std::swap(mapped_, moved.mapped_);
  std::swap(direct_, moved.direct_);
  std::swap(name_, moved.name_);
  return *this;
}

Buffer::~Buffer() { destroy(); }

void writeBuffer(const Device& device, const Buffer& destination, uint64_t offset, std::span<const std::byte> bytes) {
  requireInside(destination, offset, bytes.size());
  if (bytes.empty()) return;
  if (destination.direct_) {
    std::memcpy(destination.direct_ + offset, bytes.data(), bytes.size());
    return;
  }
  const Buffer staging(device, std::min<uint64_t>(bytes.size(), kStagingBytes), Memory::Host, "upload staging");
  for (uint64_t done = 0; done < bytes.size(); done += staging.bytes()) {
    const uint64_t chunk = std::min<uint64_t>(staging.bytes(), bytes.size() - done);
    std::memcpy(staging.mapped(), bytes.data() + done, chunk);
    device.impl().transfer([&](VkCommandBuffer commands) {
      const VkBufferCopy region{.srcOffset = 0, .dstOffset = offset + done, .size = chunk};
      vkCmdCopyBuffer(commands, staging.handle(), destination.handle(), 1, &region);
    });
  }
}

void readBuffer(const Device& device, const Buffer& source, uint64_t offset, std::span<std::byte> bytes) {
  requireInside(source, offset, bytes.size());
  if (bytes.empty()) return;
  if (source.direct_) {
    std::memcpy(bytes.data(), source.direct_ + offset, bytes.size());
    return;
  }
  const Buffer staging(device, std::min<uint64_t>(bytes.size(), kStagingBytes), Memory::Host, "download staging");
  for (uint64_t done = 0; done < bytes.size(); done += staging.bytes()) {
    const uint64_t chunk = std::min<uint64_t>(staging.bytes(), bytes.size() - done);
    device.impl().transfer([&](VkCommandBuffer commands) {
      const VkBufferCopy region{.srcOffset = offset + done, .dstOffset = 0, .size = chunk};
      vkCmdCopyBuffer(commands, source.handle(), staging.handle(), 1, &region);
    });
    std::memcpy(bytes.data() + done, staging.mapped(), chunk);
  }
}

} // namespace isophote::gpu
