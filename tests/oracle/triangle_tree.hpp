// A plain median-split tree over triangles and its closest-hit query.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <glm/glm.hpp>

#include "oracle/ray.hpp"
#include "oracle/triangle_soup.hpp"

namespace isophote::oracle {

/// Moeller and Trumbore 1997, "Fast, Minimum Storage Ray/Triangle Intersection". Edges count as inside.
/// @return true and `hit` (but its triangle) where t lies strictly inside (ray.tMin, ray.tMax)
[[nodiscard]] inline bool intersectTriangle(const Triangle& triangle, const Ray& ray, Hit& hit) {
  const glm::dvec3 p = glm::cross(ray.direction, triangle.edge2);
  const double determinant = glm::dot(triangle.edge1, p);
  if (determinant == 0) return false; // the ray runs in the plane
  const double inverse = 1 / determinant;
  const glm::dvec3 s = ray.origin - triangle.v0;
  const double b1 = glm::dot(s, p) * inverse;
  if (!(b1 >= 0 && b1 <= 1)) return false;
  const glm::dvec3 q = glm::cross(s, triangle.edge1);
  const double b2 = glm::dot(ray.direction, q) * inverse;
  if (!(b2 >= 0 && b1 + b2 <= 1)) return false;
  const double t = glm::dot(triangle.edge2, q) * inverse;
  if (!(t > ray.tMin && t < ray.tMax)) return false;
  hit.t = t;
  hit.b1 = b1;
  hit.b2 = b2;
  return true;
}

/// Borrows nothing: holds its own copy of the triangles, in the caller's order.
class TriangleTree {
public:
  explicit TriangleTree(std::vector<Triangle> triangles);

  [[nodiscard]] const std::vector<Triangle>& triangles() const { return triangles_; }

  /// The nearest hit for which `accept(hit)` holds. Each triangle is offered at most once, so `accept` may draw lots.
  template <class Accept> [[nodiscard]] Hit closest(Ray ray, Accept&& accept) const {
    Hit best;
    walk(ray, [&](const Hit& candidate) {
      if (!accept(candidate)) return false;
      best = candidate;
      ray.tMax = candidate.t;
      return false;
    });
    return best;
  }

  /// Whether any hit is accepted.
  template <class Accept> [[nodiscard]] bool occluded(Ray ray, Accept&& accept) const {
    bool found = false;
    walk(ray, [&](const Hit& candidate) { return found = accept(candidate); });
    return found;
  }

private:
  struct Node {
    glm::dvec3 lower{kInfinity};
    glm::dvec3 upper{-kInfinity};
    uint32_t first = 0; ///< leaf: into order_; inner: the left child, the right one follows it
    uint32_t count = 0; ///< 0: inner node
    int axis = 0;       ///< of the split
  };
  static constexpr int kStackSize = 64; ///< median splits halve: depth <= 32 for 2^32 triangles

  void build(uint32_t node, uint32_t begin, uint32_t end);

  /// Box slabs with NaN (0 * infinity) falling out of min and max.
  [[nodiscard]] static bool meets(const Node& node, const Ray& ray, const glm::dvec3& inverse) {
    double enter = ray.tMin, leave = ray.tMax;
    for (int axis = 0; axis < 3; ++axis) {
      double near = (node.lower[axis] - ray.origin[axis]) * inverse[axis];
      double far = (node.upper[axis] - ray.origin[axis]) * inverse[axis];
      if (inverse[axis] < 0) std::swap(near, far);
      enter = near > enter ? near : enter;
      leave = far < leave ? far : leave;
    }
    return enter <= leave * (1 + 1e-12) + 1e-300; // never lose a triangle to rounding
  }

  /// Offers every triangle the ray meets to `offer`, nearer boxes first, until it returns true. `ray` may shrink
  /// meanwhile.
  template <class Offer> void walk(const Ray& ray, Offer&& offer) const {
    if (triangles_.empty()) return;
    const glm::dvec3 inverse = 1.0 / ray.direction;
    uint32_t stack[kStackSize];
    int depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
      const Node& node = nodes_[stack[--depth]];
      if (!meets(node, ray, inverse)) continue;
      if (node.count == 0) {
        const uint32_t nearSide = ray.direction[node.axis] < 0 ? 1 : 0;
        stack[depth++] = node.first + 1 - nearSide;
        stack[depth++] = node.first + nearSide;
        continue;
      }
      for (uint32_t i = node.first; i < node.first + node.count; ++i) {
        Hit hit;
        hit.triangle = order_[i];
        if (hit.triangle == ray.leaving || hit.triangle == ray.arriving) continue;
        if (intersectTriangle(triangles_[hit.triangle], ray, hit) && offer(hit)) return;
      }
    }
  }

  std::vector<Triangle> triangles_;
  std::vector<uint32_t> order_;
  std::vector<Node> nodes_;
};

} // namespace isophote::oracle
