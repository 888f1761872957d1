#include "upload/place_order.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "accel/bvh.hpp"
#include "accel/z_order.hpp"

namespace isophote {

void sortByPlace(std::span<gpu::BvhTriangle> triangles) {
  std::vector<Box> boxes(triangles.size());
  for (size_t i = 0; i < triangles.size(); ++i) {
    for (const glm::vec3& v : {triangles[i].v0, triangles[i].v1, triangles[i].v2}) boxes[i].grow(v);
  }
  std::vector<gpu::BvhTriangle> sorted;
  sorted.reserve(triangles.size());
  for (const uint32_t number : zOrder(boxes)) sorted.push_back(triangles[number]);
  std::copy(sorted.begin(), sorted.end(), triangles.begin());
}

} // namespace isophote
