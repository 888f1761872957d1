#include "gpu/acceleration_structures.hpp"

#include "isophote/error.hpp"

#include "gpu/device_impl.hpp"
#include "gpu/vulkan_check.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace isophote::gpu {
namespace {

/// Bottom levels are built together as long as what they need before compaction stays below this.
constexpr uint64_t kBatchBytes = 256ull << 20;
constexpr size_t kBatchStructures = 1024;
constexpr uint64_t kStructureAlignment = 256; // of VkAccelerationStructureCreateInfoKHR::offset
constexpr uint64_t kTriangleBytes = 48;
constexpr uint64_t kCornerBytes = 16;
constexpr uint32_t kMaxCustomIndex = (1u << 24) - 1;

uint64_t aligned(uint64_t bytes, uint64_t alignment) { return (bytes + alignment - 1) / alignment * alignment; }

void requireAtMost(uint64_t count, uint64_t limit, const Device::Impl& device, const char* what) {
  if (count <= limit) return;
  throw LimitError("the scene has " + std::to_string(count) + " " + what + "; ray query on " + device.info.name +
                   " takes at most " + std::to_string(limit));
}

/// Orders builds and copies of structures against one another and against the kernels that follow.
void recordBuildBarrier(VkCommandBuffer commands) {
  constexpr VkPipelineStageFlags2 kBuild = VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_BUILD_BIT_KHR;
  const VkMemoryBarrier2 barrier{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                 .srcStageMask = kBuild | VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                                 .srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT,
                                 .dstStageMask = kBuild | VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT |
                                                 VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                 .dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT};
  const VkDependencyInfo dependency{
      .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .memoryBarrierCount = 1, .pMemoryBarriers = &barrier};
  vkCmdPipelineBarrier2(commands, &dependency);
}

VkAccelerationStructureGeometryKHR geometryOf(const AccelerationGeometry& part) {
  VkAccelerationStructureGeometryKHR geometry{.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR,
                                              .flags = part.opaque ? VkGeometryFlagsKHR{VK_GEOMETRY_OPAQUE_BIT_KHR}
                                                                   : VkGeometryFlagsKHR{}};
  if (part.kind == AccelerationGeometry::Kind::Boxes) {
    geometry.geometryType = VK_GEOMETRY_TYPE_AABBS_KHR;
    geometry.geometry.aabbs = {.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_AABBS_DATA_KHR,
                               .data = {.deviceAddress = part.address},
                               .stride = sizeof(VkAabbPositionsKHR)};
  } else {
    geometry.geometryType = VK_GEOMETRY_TYPE_TRIANGLES_KHR;
    geometry.geometry.triangles = {.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_TRIANGLES_DATA_KHR,
                                   .vertexFormat = VK_FORMAT_R32G32B32_SFLOAT,
                                   .vertexData = {.deviceAddress = part.address},
                                   .vertexStride = kCornerBytes,
                                   .maxVertex = 3 * part.count - 1,
                                   .indexType = VK_INDEX_TYPE_NONE_KHR};
  }
  return geometry;
}

/// One structure to be built: the Vulkan structs of it, which point into each other.
class Build {
public:
  Build(const Device::Impl& device, VkAccelerationStructureTypeKHR type, VkBuildAccelerationStructureFlagsKHR flags,
        std::vector<VkAccelerationStructureGeometryKHR> geometries, const std::vector<uint32_t>& counts)
      : geometries_(std::move(geometries)) {
    for (const uint32_t count : counts) ranges_.push_back({.primitiveCount = count});
    info_ = {.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR,
             .type = type,
             .flags = VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR | flags,
             .mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_BUILD_KHR,
             .geometryCount = static_cast<uint32_t>(geometries_.size()),
             .pGeometries = geometries_.data()};
    sizes_ = {.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR};
    device.acceleration->buildSizes(device.handle, VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR, &info_,
                                    counts.data(), &sizes_);
    scratchAlignment_ = device.acceleration->limits.minAccelerationStructureScratchOffsetAlignment;
  }
  Build(Build&&) = default; // the vectors keep their memory, so the pointers stay right

  [[nodiscard]] uint64_t bytes() const { return aligned(sizes_.accelerationStructureSize, kStructureAlignment); }
  /// With room to align the address it is put at.
  [[nodiscard]] uint64_t scratchBytes() const {
    return aligned(sizes_.buildScratchSize, scratchAlignment_) + scratchAlignment_;
  }
  [[nodiscard]] VkAccelerationStructureTypeKHR type() const { return info_.type; }

  void record(const Device::Impl& device, VkCommandBuffer commands, VkAccelerationStructureKHR into, uint64_t scratch) {
    info_.dstAccelerationStructure = into;
    info_.scratchData.deviceAddress = aligned(scratch, scratchAlignment_);
    const VkAccelerationStructureBuildRangeInfoKHR* ranges = ranges_.data();
    device.acceleration->build(commands, 1, &info_, &ranges);
  }

private:
  std::vector<VkAccelerationStructureGeometryKHR> geometries_;
  std::vector<VkAccelerationStructureBuildRangeInfoKHR> ranges_;
  VkAccelerationStructureBuildGeometryInfoKHR info_{};
  VkAccelerationStructureBuildSizesInfoKHR sizes_{};
  uint64_t scratchAlignment_ = 1;
};

Build bottomLevelBuild(const Device::Impl& device, const BottomLevel& level) {
  std::vector<VkAccelerationStructureGeometryKHR> geometries;
  std::vector<uint32_t> counts;
  uint64_t primitives = 0;
  for (const AccelerationGeometry& part : level) {
    geometries.push_back(geometryOf(part));
    counts.push_back(part.count);
    primitives += part.count;
  }
  requireAtMost(primitives, device.acceleration->limits.maxPrimitiveCount, device, "triangles in one mesh");
  requireAtMost(level.size(), device.acceleration->limits.maxGeometryCount, device, "geometries in one mesh");
  return {device, VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR,
          VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_COMPACTION_BIT_KHR, std::move(geometries), counts};
}

VkAccelerationStructureKHR createStructure(const Device::Impl& device, const Buffer& storage, uint64_t offset,
                                           uint64_t bytes, VkAccelerationStructureTypeKHR type) {
  const VkAccelerationStructureCreateInfoKHR info{.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_CREATE_INFO_KHR,
                                                  .buffer = storage.handle(),
                                                  .offset = offset,
                                                  .size = bytes,
                                                  .type = type};
  VkAccelerationStructureKHR structure = VK_NULL_HANDLE;
  check(device.acceleration->create(device.handle, &info, nullptr, &structure), "vkCreateAccelerationStructureKHR");
  device.name(structure, VK_OBJECT_TYPE_ACCELERATION_STRUCTURE_KHR, storage.name());
  return structure;
}

uint64_t addressOf(const Device::Impl& device, VkAccelerationStructureKHR structure) {
  const VkAccelerationStructureDeviceAddressInfoKHR info{
      .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_DEVICE_ADDRESS_INFO_KHR, .accelerationStructure = structure};
  return device.acceleration->address(device.handle, &info);
}

/// Structures that live for the length of a batch.
class Structures {
public:
  explicit Structures(const Device::Impl& device) : device_(device) {}
  Structures(const Structures&) = delete;
  Structures& operator=(const Structures&) = delete;
  ~Structures() {
    for (const auto structure : handles) device_.acceleration->destroy(device_.handle, structure, nullptr);
  }
  std::vector<VkAccelerationStructureKHR> handles;

private:
  const Device::Impl& device_;
};

/// Where a structure's size after compaction is asked.
class SizeQueries {
public:
  SizeQueries(const Device::Impl& device, size_t count) : device_(device), count_(static_cast<uint32_t>(count)) {
    const VkQueryPoolCreateInfo info{.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                     .queryType = VK_QUERY_TYPE_ACCELERATION_STRUCTURE_COMPACTED_SIZE_KHR,
                                     .queryCount = count_};
    check(vkCreateQueryPool(device.handle, &info, nullptr, &pool_), "vkCreateQueryPool");
    vkResetQueryPool(device.handle, pool_, 0, count_);
  }
  SizeQueries(const SizeQueries&) = delete;
  SizeQueries& operator=(const SizeQueries&) = delete;
  ~SizeQueries() { vkDestroyQueryPool(device_.handle, pool_, nullptr); }

  void record(VkCommandBuffer commands, const std::vector<VkAccelerationStructureKHR>& structures) const {
    device_.acceleration->writeProperties(commands, count_, structures.data(),
                                          VK_QUERY_TYPE_ACCELERATION_STRUCTURE_COMPACTED_SIZE_KHR, pool_, 0);
  }
  [[nodiscard]] std::vector<VkDeviceSize> read() const {
    std::vector<VkDeviceSize> sizes(count_);
    check(vkGetQueryPoolResults(device_.handle, pool_, 0, count_, sizes.size() * sizeof(VkDeviceSize), sizes.data(),
                                sizeof(VkDeviceSize), VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
          "vkGetQueryPoolResults");
    return sizes;
  }

private:
  const Device::Impl& device_;
  uint32_t count_;
  VkQueryPool pool_ = VK_NULL_HANDLE;
};

/// Builds a batch of bottom levels and moves them to a buffer of no more than they need; appends their handles.
Buffer buildCompacted(const Device& owner, std::vector<Build>& batch, std::vector<VkAccelerationStructureKHR>& into) {
  Device::Impl& device = owner.impl();
  uint64_t bytes = 0, scratchBytes = 0;
  for (const Build& build : batch) {
    bytes += build.bytes();
    scratchBytes += build.scratchBytes();
  }
  const Buffer loose(owner, bytes, Memory::Device, "bottom levels before compaction");
  Structures built(device);
  const SizeQueries queries(device, batch.size());
  {
    const Buffer scratch(owner, scratchBytes, Memory::Device, "bottom levels' scratch");
    uint64_t offset = 0;
    for (const Build& build : batch) {
      built.handles.push_back(createStructure(device, loose, offset, build.bytes(), build.type()));
      offset += build.bytes();
    }
    device.transfer([&](VkCommandBuffer commands) {
      recordBuildBarrier(commands);
      uint64_t free = scratch.address();
      for (size_t i = 0; i < batch.size(); ++i) {
        batch[i].record(device, commands, built.handles[i], free);
        free += batch[i].scratchBytes();
      }
      recordBuildBarrier(commands);
      queries.record(commands, built.handles);
    });
  }
  const std::vector<VkDeviceSize> sizes = queries.read();
  bytes = 0;
  for (const VkDeviceSize size : sizes) bytes += aligned(size, kStructureAlignment);
  Buffer compact(owner, bytes, Memory::Device, "bottom levels");
  const size_t first = into.size();
  uint64_t offset = 0;
  for (size_t i = 0; i < batch.size(); ++i) {
    into.push_back(createStructure(device, compact, offset, sizes[i], batch[i].type()));
    offset += aligned(sizes[i], kStructureAlignment);
  }
  device.transfer([&](VkCommandBuffer commands) {
    for (size_t i = 0; i < batch.size(); ++i) {
      const VkCopyAccelerationStructureInfoKHR copy{.sType = VK_STRUCTURE_TYPE_COPY_ACCELERATION_STRUCTURE_INFO_KHR,
                                                    .src = built.handles[i],
                                                    .dst = into[first + i],
                                                    .mode = VK_COPY_ACCELERATION_STRUCTURE_MODE_COMPACT_KHR};
      device.acceleration->copy(commands, &copy);
    }
    recordBuildBarrier(commands);
  });
  return compact;
}

} // namespace

AccelerationStructures::AccelerationStructures(const Device& device, std::span<const BottomLevel> bottomLevels,
                                               std::span<const AccelerationInstance> instances)
    : device_(&device.impl()) {
  if (!device_->acceleration) throw UsageError("the device was made without ray query");
  if (instances.empty()) return;
  try {
    buildBottomLevels(device, bottomLevels);
    buildTopLevel(device, instances);
  } catch (...) {
    destroy();
    throw;
  }
}

void AccelerationStructures::buildBottomLevels(const Device& device, std::span<const BottomLevel> bottomLevels) {
  std::vector<Build> batch;
  uint64_t batchBytes = 0;
  const auto finishBatch = [&] {
    if (!batch.empty()) storage_.push_back(buildCompacted(device, batch, structures_));
    batch.clear();
    batchBytes = 0;
  };
  for (const BottomLevel& level : bottomLevels) {
    Build build = bottomLevelBuild(*device_, level);
    const uint64_t needed = build.bytes() + build.scratchBytes();
    if (batch.size() == kBatchStructures || batchBytes + needed > kBatchBytes) finishBatch();
    batchBytes += needed;
    batch.push_back(std::move(build));
  }
  finishBatch();
}

void AccelerationStructures::buildTopLevel(const Device& device, std::span<const AccelerationInstance> instances) {
  requireAtMost(instances.size(), device_->acceleration->limits.maxInstanceCount, *device_, "instances");
  std::vector<VkAccelerationStructureInstanceKHR> records;
  records.reserve(instances.size());
  for (const AccelerationInstance& instance : instances) {
    requireAtMost(instance.customIndex, kMaxCustomIndex, *device_, "geometries");
    records.push_back({.transform = instance.worldFromObject,
                       .instanceCustomIndex = instance.customIndex & kMaxCustomIndex,
                       .mask = 0xff,
                       .accelerationStructureReference = addressOf(*device_, structures_.at(instance.bottomLevel))});
  }
  const Buffer recordBuffer = uploadBuffer(device, records, "instances of the top level");
  VkAccelerationStructureGeometryKHR geometry{.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR,
                                              .geometryType = VK_GEOMETRY_TYPE_INSTANCES_KHR};
  geometry.geometry.instances = {.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_INSTANCES_DATA_KHR,
                                 .data = {.deviceAddress = recordBuffer.address()}};
  Build build(*device_, VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR, 0, {geometry},
              {static_cast<uint32_t>(records.size())});
  const Buffer scratch(device, build.scratchBytes(), Memory::Device, "top level's scratch");
  storage_.emplace_back(device, build.bytes(), Memory::Device, "top level");
  structures_.push_back(createStructure(*device_, storage_.back(), 0, build.bytes(), build.type()));
  device_->transfer([&](VkCommandBuffer commands) {
    recordBuildBarrier(commands);
    build.record(*device_, commands, structures_.back(), scratch.address());
    recordBuildBarrier(commands);
  });
  topLevel_ = addressOf(*device_, structures_.back());
}

uint64_t AccelerationStructures::bytes() const {
  uint64_t sum = 0;
  for (const Buffer& buffer : storage_) sum += buffer.bytes();
  return sum;
}

void AccelerationStructures::destroy() noexcept {
  for (const auto structure : structures_) device_->acceleration->destroy(device_->handle, structure, nullptr);
}

AccelerationStructures::AccelerationStructures(AccelerationStructures&& other) noexcept
    : device_(std::exchange(other.device_, nullptr)), storage_(std::exchange(other.storage_, {})),
      structures_(std::exchange(other.structures_, {})), topLevel_(std::exchange(other.topLevel_, 0)) {}

AccelerationStructures& AccelerationStructures::operator=(AccelerationStructures&& other) noexcept {
  AccelerationStructures moved(std::move(other));
  std::swap(device_, moved.device_);
  std::swap(storage_, moved.storage_);
  std::swap(structures_, moved.structures_);
  std::swap(topLevel_, moved.topLevel_);
  return *this;
}

AccelerationStructures::~AccelerationStructures() { destroy(); }

} // namespace isophote::gpu
