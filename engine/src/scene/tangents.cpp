#include "scene/tangents.hpp"

#include <array>
#include <cmath>
#include <unordered_map>
#include <vector>

#include "scene/hash_bytes.hpp"

namespace isophote {
namespace {

/// What makes two corners one vertex to MikkTSpace: position, normal, uv, and the sign of the uv area.
struct CornerKey {
  std::array<float, 8> values{};
  bool mirrored = false;
  bool operator==(const CornerKey&) const = default;
};

struct CornerKeyHash {
  size_t operator()(const CornerKey& key) const {
    return hashBytes(key.values.data(), sizeof(key.values)) * 2 + (key.mirrored ? 1 : 0);
  }
};

struct TangentSum {
  glm::dvec3 direction{0};
  glm::dvec3 normal{0};
};

/// How a triangle's uv runs over it.
struct TriangleFrame {
  glm::dvec3 normal{0};     ///< unit, geometric
  glm::dvec3 uDirection{0}; ///< unit; zero where the triangle has no uv area
  bool mirrored = false;    ///< the uv triangle runs clockwise, in coordinates with v up
};

glm::dvec3 normalizeOrZero(glm::dvec3 v) {
  const double length = glm::length(v);
  return length > 0 ? v / length : glm::dvec3(0);
}

/// Any unit vector in the plane of `normal` (Duff et al. 2017, "Building an Orthonormal Basis, Revisited", listing 3).
glm::dvec3 anyTangent(glm::dvec3 normal) {
  const double sign = std::copysign(1.0, normal.z);
  const double a = -1.0 / (sign + normal.z);
  return {1.0 + sign * normal.x * normal.x * a, sign * normal.x * normal.y * a, -sign * normal.x};
}

class TangentGenerator {
public:
  TangentGenerator(Primitive& primitive, uint32_t uvSet) : primitive_(primitive), uvs_(primitive.uvs[uvSet]) {}

  void run() {
    const size_t triangleCount = primitive_.indices.size() / 3;
    std::vector<uint32_t> groups(primitive_.indices.size());
    for (const bool withUvArea : {true, false}) { // those without take what the others found
      for (size_t t = 0; t < triangleCount; ++t) addTriangle(3 * t, withUvArea, groups);
    }
    splitVertices(groups);
  }

private:
  TriangleFrame frame(const std::array<uint32_t, 3>& v) const {
    const glm::dvec3 p0(primitive_.positions[v[0]]);
    const glm::dvec3 d1 = glm::dvec3(primitive_.positions[v[1]]) - p0;
    const glm::dvec3 d2 = glm::dvec3(primitive_.positions[v[2]]) - p0;
    const glm::dvec2 t1 = glm::dvec2(uvs_[v[1]]) - glm::dvec2(uvs_[v[0]]);
    const glm::dvec2 t2 = glm::dvec2(uvs_[v[2]]) - glm::dvec2(uvs_[v[0]]);
    const double area = t1.x * t2.y - t1.y * t2.x; // twice the signed uv area
    TriangleFrame result;
    result.normal = normalizeOrZero(glm::cross(d1, d2));
    result.mirrored = area > 0; // v runs down
    if (area != 0) result.uDirection = normalizeOrZero(d1 * t2.y - d2 * t1.y) * (area > 0 ? 1.0 : -1.0);
    return result;
  }

  glm::dvec3 normalAt(uint32_t vertex, const TriangleFrame& frame) const {
    return primitive_.normals.empty() ? frame.normal : glm::dvec3(primitive_.normals[vertex]);
  }

  void addTriangle(size_t firstCorner, bool withUvArea, std::vector<uint32_t>& groups) {
    const std::array<uint32_t, 3> v{primitive_.indices[firstCorner], primitive_.indices[firstCorner + 1],
                                    primitive_.indices[firstCorner + 2]};
    const TriangleFrame triangle = frame(v);
    const bool hasUvArea = triangle.uDirection != glm::dvec3(0);
    if (hasUvArea != withUvArea) return;
    for (size_t k = 0; k < 3; ++k) {
      const glm::dvec3 normal = normalAt(v[k], triangle);
      const glm::vec3 p = primitive_.positions[v[k]];
      const glm::vec2 uv = uvs_[v[k]];
      CornerKey key;
      // + 0 makes -0 and 0 the same bits
      key.values = {p.x + 0,
                    p.y + 0,
                    p.z + 0,
                    static_cast<float>(normal.x) + 0,
                    static_cast<float>(normal.y) + 0,
                    static_cast<float>(normal.z) + 0,
                    uv.x + 0,
                    uv.y + 0};
      key.mirrored = triangle.mirrored;
      const uint32_t group = findGroup(key, !hasUvArea);
      groups[firstCorner + k] = group;
      sums_[group].normal = normal;
      sums_[group].direction += cornerDirection(v, k, normal, triangle.uDirection);
    }
  }

  /// A triangle without uv area has no orientation: it joins the mirrored group where only that one exists.
  uint32_t findGroup(CornerKey key, bool anyOrientation) {
    if (anyOrientation && !groupOf_.contains(key)) {
      CornerKey other = key;
      other.mirrored = !other.mirrored;
      if (groupOf_.contains(other)) key = other;
    }
    const auto [found, isNew] = groupOf_.try_emplace(key, static_cast<uint32_t>(sums_.size()));
    if (isNew) {
      sums_.emplace_back();
      mirrored_.push_back(key.mirrored);
    }
    return found->second;
  }

  /// The u direction in the plane of the normal, weighted with the triangle's angle at corner `k` in that plane.
  glm::dvec3 cornerDirection(const std::array<uint32_t, 3>& v, size_t k, glm::dvec3 normal, glm::dvec3 u) const {
    const glm::dvec3 here(primitive_.positions[v[k]]);
    const auto inPlane = [&](glm::dvec3 d) { return normalizeOrZero(d - normal * glm::dot(normal, d)); };
    const glm::dvec3 next = inPlane(glm::dvec3(primitive_.positions[v[(k + 1) % 3]]) - here);
    const glm::dvec3 previous = inPlane(glm::dvec3(primitive_.positions[v[(k + 2) % 3]]) - here);
    return inPlane(u) * std::acos(glm::clamp(glm::dot(next, previous), -1.0, 1.0));
  }

  glm::vec4 tangent(uint32_t group) const {
    glm::dvec3 direction = normalizeOrZero(sums_[group].direction);
    if (direction == glm::dvec3(0)) direction = anyTangent(sums_[group].normal);
    return glm::vec4(glm::vec3(direction), mirrored_[group] ? -1.0f : 1.0f);
  }

  /// Gives each pair of vertex and group its own vertex; the first one keeps the number.
  void splitVertices(const std::vector<uint32_t>& groups) {
    constexpr uint32_t kUnset = ~0u;
    std::vector<uint32_t> firstGroup(primitive_.positions.size(), kUnset);
    std::unordered_map<uint64_t, uint32_t> copies;
    primitive_.tangents.assign(primitive_.positions.size(), glm::vec4(1, 0, 0, 1));
    for (size_t corner = 0; corner < groups.size(); ++corner) {
      uint32_t& vertex = primitive_.indices[corner];
      const uint32_t group = groups[corner];
      if (firstGroup[vertex] == kUnset) firstGroup[vertex] = group;
      if (firstGroup[vertex] != group) {
        const uint64_t key = uint64_t{vertex} << 32 | group;
        const auto [found, isNew] = copies.try_emplace(key, static_cast<uint32_t>(primitive_.positions.size()));
        if (isNew) copyVertex(vertex);
        vertex = found->second;
      }
      primitive_.tangents[vertex] = tangent(group);
    }
  }

  void copyVertex(uint32_t vertex) {
    const auto copy = [vertex](auto& values) {
      if (values.empty()) return;
      const auto value = values[vertex]; // push_back may move the array
      values.push_back(value);
    };
    copy(primitive_.positions);
    copy(primitive_.normals);
    copy(primitive_.tangents);
    copy(primitive_.colors);
    for (auto& uvs : primitive_.uvs) copy(uvs);
  }

  Primitive& primitive_;
  const std::vector<glm::vec2>& uvs_;
  std::unordered_map<CornerKey, uint32_t, CornerKeyHash> groupOf_;
  std::vector<TangentSum> sums_; ///< of each group
  std::vector<bool> mirrored_;
};

} // namespace

void generateTangents(Primitive& primitive, uint32_t uvSet) { TangentGenerator(primitive, uvSet).run(); }

} // namespace isophote
