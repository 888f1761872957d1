#include "upload/place_order.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "accel/bvh.hpp"

namespace isophote {
namespace {

constexpr uint32_t kBitsPerAxis = 21;

Box boxOf(const gpu::BvhTriangle& triangle) {
  Box box;
  for (const glm::vec3& v : {triangle.v0, triangle.v1, triangle.v2}) box.grow(v);
  return box;
}

/// The bits of three cell numbers in turn.
uint64_t zOrder(const glm::dvec3& cell) {
  uint64_t key = 0;
  for (uint32_t axis = 0; axis < 3; ++axis) {
    const auto number = static_cast<uint64_t>(cell[axis]);
    for (uint32_t bit = 0; bit < kBitsPerAxis; ++bit) key |= (number >> bit & 1u) << (3 * bit + axis);
  }
  return key;
}

} // namespace

void sortByPlace(std::span<gpu::BvhTriangle> triangles) {
  Box all;
  for (const gpu::BvhTriangle& triangle : triangles) {
    for (const glm::vec3& v : {triangle.v0, triangle.v1, triangle.v2}) all.grow(v);
  }
  constexpr double kCells = 1u << kBitsPerAxis;
  const glm::dvec3 lower(all.lower), size(glm::dvec3(all.upper) - lower);
  std::vector<std::pair<uint64_t, uint32_t>> order; // key, where the triangle is
  order.reserve(triangles.size());
  for (uint32_t i = 0; i < triangles.size(); ++i) {
    const Box box = boxOf(triangles[i]);
    const glm::dvec3 center = 0.5 * (glm::dvec3(box.lower) + glm::dvec3(box.upper));
    glm::dvec3 cell(0);
    for (int axis = 0; axis < 3; ++axis) {
      if (size[axis] > 0) cell[axis] = std::min((center[axis] - lower[axis]) / size[axis] * kCells, kCells - 1);
    }
    order.emplace_back(zOrder(cell), i);
  }
  std::sort(order.begin(), order.end());
  std::vector<gpu::BvhTriangle> sorted;
  sorted.reserve(triangles.size());
  for (const auto& [key, index] : order) sorted.push_back(triangles[index]);
  std::copy(sorted.begin(), sorted.end(), triangles.begin());
}

} // namespace isophote
