// What a device traces rays through by itself: bottom levels over triangles or boxes, and the top level over their
// instances.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gpu/buffer.hpp"

namespace isophote::gpu {

/// Triangles, or boxes in which a kernel intersects by itself.
struct AccelerationGeometry {
  enum class Kind : uint32_t {
    Triangles, ///< 48 bytes each: three corners of x, y, z and a word that is not read
    Boxes      ///< VkAabbPositionsKHR
  };
  Kind kind = Kind::Triangles;
  uint64_t address = 0; ///< on the device; read by the constructor only
  uint32_t count = 0;   ///< at least one
  bool opaque = true;   ///< false: every candidate is put to the kernel
};

/// Rays see their geometries by position in this list.
using BottomLevel = std::vector<AccelerationGeometry>;

/// The members that a kernel reads: its position in the list of instances, and instanceCustomIndex.
struct AccelerationInstance {
  uint32_t bottomLevel = 0;
  uint32_t customIndex = 0; ///< below 2^24
  VkTransformMatrixKHR worldFromObject{};
};

/// Built once, compacted, immutable. Move-only.
class AccelerationStructures {
public:
  AccelerationStructures() = default;
  /// Waits until all is built.
  /// @param device  with DeviceOptions::rayQuery
  /// @throws LimitError where memory runs out or a count is beyond the device's limits
  AccelerationStructures(const Device& device, std::span<const BottomLevel> bottomLevels,
                         std::span<const AccelerationInstance> instances);
  AccelerationStructures(AccelerationStructures&& other) noexcept;
  AccelerationStructures& operator=(AccelerationStructures&& other) noexcept;
  ~AccelerationStructures();

  /// Device address, for accelerationStructureEXT in kernels; 0: none was built.
  [[nodiscard]] uint64_t topLevel() const { return topLevel_; }
  [[nodiscard]] uint64_t bytes() const;

private:
  void buildBottomLevels(const Device& device, std::span<const BottomLevel> bottomLevels);
  void buildTopLevel(const Device& device, std::span<const AccelerationInstance> instances);
  void destroy() noexcept;

  Device::Impl* device_ = nullptr; // not the Device itself, which may move
  std::vector<Buffer> storage_;
  std::vector<VkAccelerationStructureKHR> structures_; // bottom levels in their order, then the top level
  uint64_t topLevel_ = 0;
};

} // namespace isophote::gpu
