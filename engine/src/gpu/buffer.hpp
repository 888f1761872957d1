// Device memory with an address.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "isophote/device.hpp"

namespace isophote::gpu {

enum class Memory : uint32_t {
  Device, ///< device-local; read and written through staging
  Host    ///< mapped for its lifetime, coherent
};

/// A storage buffer with a device address, move-only, named for debuggers. Also usable for indirect arguments,
/// transfers both ways and, on a device with ray query, acceleration structures. One allocation each. Size 0 makes a
/// null buffer with address 0.
class Buffer {
public:
  Buffer() = default;
  /// @throws LimitError naming the buffer and the needed and available bytes when memory runs out
  Buffer(const Device& device, uint64_t bytes, Memory memory, const char* name);
  Buffer(Buffer&& other) noexcept;
  Buffer& operator=(Buffer&& other) noexcept;
  ~Buffer();

  [[nodiscard]] VkBuffer handle() const { return buffer_; }
  [[nodiscard]] uint64_t address() const { return address_; }
  [[nodiscard]] uint64_t bytes() const { return bytes_; }
  [[nodiscard]] const std::string& name() const { return name_; }
  /// Host pointer; null for Memory::Device.
  [[nodiscard]] void* mapped() const { return mapped_; }
  template <class T> [[nodiscard]] T* mappedAs() const { return static_cast<T*>(mapped_); }

private:
  friend void writeBuffer(const Device&, const Buffer&, uint64_t, std::span<const std::byte>);
  friend void readBuffer(const Device&, const Buffer&, uint64_t, std::span<std::byte>);
  void create(Memory memory);
  void destroy() noexcept;

  Device::Impl* device_ = nullptr; // not the Device itself, which may move
  VkBuffer buffer_ = VK_NULL_HANDLE;
  VkDeviceMemory memory_ = VK_NULL_HANDLE;
  uint64_t memoryBytes_ = 0;
  uint64_t address_ = 0;
  uint64_t bytes_ = 0;
  void* mapped_ = nullptr;
  std::byte* direct_ = nullptr; // where the host reaches the memory, also of Memory::Device on unified memory
  std::string name_;
};

/// Copies bytes into / out of any buffer, through staging in bounded chunks; waits until done.
void writeBuffer(const Device& device, const Buffer& destination, uint64_t offset, std::span<const std::byte> bytes);
void readBuffer(const Device& device, const Buffer& source, uint64_t offset, std::span<std::byte> bytes);

/// A device-local buffer filled with `values` (null buffer where empty).
template <class T>
[[nodiscard]] Buffer uploadBuffer(const Device& device, const std::vector<T>& values, const char* name) {
  Buffer buffer(device, values.size() * sizeof(T), Memory::Device, name);
  if (!values.empty()) writeBuffer(device, buffer, 0, std::as_bytes(std::span(values)));
  return buffer;
}

} // namespace isophote::gpu
