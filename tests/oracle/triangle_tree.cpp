#include "oracle/triangle_tree.hpp"

#include <numeric>

namespace isophote::oracle {

namespace {
constexpr uint32_t kLeafTriangles = 3;

/// Three times the centroid: good enough to sort by.
glm::dvec3 centroid(const Triangle& triangle) { return 3.0 * triangle.v0 + triangle.edge1 + triangle.edge2; }
} // namespace

TriangleTree::TriangleTree(std::vector<Triangle> triangles) : triangles_(std::move(triangles)) {
  order_.resize(triangles_.size());
  std::iota(order_.begin(), order_.end(), 0u);
  nodes_.emplace_back();
  build(0, 0, static_cast<uint32_t>(triangles_.size()));
}

void TriangleTree::build(uint32_t nodeIndex, uint32_t begin, uint32_t end) {
  Node node;
  glm::dvec3 lower(kInfinity), upper(-kInfinity); // of the centroids
  for (uint32_t i = begin; i < end; ++i) {
    const Triangle& triangle = triangles_[order_[i]];
    for (const glm::dvec3& vertex : {triangle.v0, triangle.v0 + triangle.edge1, triangle.v0 + triangle.edge2}) {
      node.lower = glm::min(node.lower, vertex);
      node.upper = glm::max(node.upper, vertex);
    }
    lower = glm::min(lower, centroid(triangle));
    upper = glm::max(upper, centroid(triangle));
  }
  if (end - begin <= kLeafTriangles) {
    node.first = begin;
    node.count = end - begin;
    nodes_[nodeIndex] = node;
    return;
  }
  const glm::dvec3 extent = upper - lower;
  node.axis = extent.x >= extent.y ? (extent.x >= extent.z ? 0 : 2) : (extent.y >= extent.z ? 1 : 2);
  const uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end, [&](uint32_t a, uint32_t b) {
    return centroid(triangles_[a])[node.axis] < centroid(triangles_[b])[node.axis];
  });
  node.first = static_cast<uint32_t>(nodes_.size());
  nodes_.resize(nodes_.size() + 2);
  nodes_[nodeIndex] = node;
  build(node.first, begin, middle);
  build(node.first + 1, middle, end);
}

} // namespace isophote::oracle
