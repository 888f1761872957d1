#include "upload/acceleration.hpp"

#include <cmath>
#include <limits>
#include <vector>

namespace isophote {
namespace {

constexpr uint32_t kNoBottomLevel = gpu::kInvalidIndex;

VkTransformMatrixKHR matrixOf(const gpu::vec4 (&rows)[3]) {
  VkTransformMatrixKHR matrix;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) matrix.matrix[row][column] = rows[row][column];
  }
  return matrix;
}

constexpr VkTransformMatrixKHR kIdentity{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

VkAabbPositionsKHR boxOf(const gpu::vec4& sphere) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const auto lower = [&](int axis) { return std::nextafter(sphere[axis] - sphere.w, -kInfinity); };
  const auto upper = [&](int axis) { return std::nextafter(sphere[axis] + sphere.w, kInfinity); };
  return {lower(0), lower(1), lower(2), upper(0), upper(1), upper(2)};
}

/// The bottom level of a mesh and the number of its first range.
struct PlacedMesh {
  uint32_t bottomLevel = kNoBottomLevel;
  uint32_t firstRange = 0;
};

} // namespace

gpu::AccelerationStructures buildAcceleration(const Device& device, const PackedScene& packed, gpu::Address triangles) {
  std::vector<gpu::BottomLevel> bottomLevels;
  std::vector<PlacedMesh> meshes(packed.meshTriangles.size());
  for (uint32_t i = 0; i < packed.triangleRanges.size(); ++i) {
    const TriangleRange& range = packed.triangleRanges[i];
    PlacedMesh& mesh = meshes[range.mesh];
    if (mesh.bottomLevel == kNoBottomLevel) {
      mesh = {static_cast<uint32_t>(bottomLevels.size()), i};
      bottomLevels.emplace_back();
    }
    bottomLevels.back().push_back({.kind = gpu::AccelerationGeometry::Kind::Triangles,
                                   .address = triangles + uint64_t{packed.rangeStarts[i]} * sizeof(gpu::BvhTriangle),
                                   .count = range.count,
                                   .opaque = range.opaque});
  }

  std::vector<gpu::AccelerationInstance> instances;
  std::vector<VkAabbPositionsKHR> boxes;
  for (const gpu::InstanceRecord& record : packed.instances) {
    if (record.flags == gpu::kInstanceSphere) {
      boxes.push_back(boxOf(record.worldFromObject[0]));
    } else {
      const PlacedMesh& mesh = meshes[record.mesh];
      instances.push_back({mesh.bottomLevel, mesh.firstRange, matrixOf(record.worldFromObject)});
    }
  }
  const gpu::Buffer boxBuffer = gpu::uploadBuffer(device, boxes, "boxes of sphere lights");
  if (!boxes.empty()) {
    instances.push_back({static_cast<uint32_t>(bottomLevels.size()), 0, kIdentity});
    bottomLevels.push_back({{.kind = gpu::AccelerationGeometry::Kind::Boxes,
                             .address = boxBuffer.address(),
                             .count = static_cast<uint32_t>(boxes.size()),
                             .opaque = false}});
  }
  return {device, bottomLevels, instances};
}

} // namespace isophote
