#include "scene/triangle_list.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "scene/hash_bytes.hpp"

namespace isophote {
namespace {

/// Keeps the triangles for which keep(t) holds. Returns how many went.
template <class Keep> uint64_t filterTriangles(std::vector<uint32_t>& indices, const Keep& keep) {
  const size_t count = indices.size() / 3;
  size_t kept = 0;
  for (size_t t = 0; t < count; ++t) {
    if (!keep(t)) continue;
    for (size_t k = 0; k < 3; ++k) indices[3 * kept + k] = indices[3 * t + k];
    ++kept;
  }
  indices.resize(3 * kept);
  return count - kept;
}

/// Nine coordinates, rotated so that the smallest corner comes first.
std::array<float, 9> corners(const Primitive& primitive, size_t triangle) {
  std::array<std::array<float, 3>, 3> points{};
  for (size_t k = 0; k < 3; ++k) {
    const glm::vec3 p = primitive.positions[primitive.indices[3 * triangle + k]];
    points[k] = {p.x + 0, p.y + 0, p.z + 0}; // + 0 makes -0 and 0 the same bits
  }
  std::rotate(points.begin(), std::min_element(points.begin(), points.end()), points.end());
  std::array<float, 9> result{};
  for (size_t i = 0; i < 9; ++i) result[i] = points[i / 3][i % 3];
  return result;
}

} // namespace

std::vector<uint32_t> triangleList(const std::vector<uint32_t>& indices, Topology topology) {
  std::vector<uint32_t> result;
  if (topology == Topology::Triangles) {
    result = indices;
    result.resize(indices.size() / 3 * 3);
    return result;
  }
  for (size_t i = 0; i + 2 < indices.size(); ++i) {
    if (topology == Topology::Fan) {
      result.insert(result.end(), {indices[i + 1], indices[i + 2], indices[0]});
    } else {
      result.insert(result.end(), {indices[i], indices[i + 1 + i % 2], indices[i + 2 - i % 2]});
    }
  }
  return result;
}

uint64_t removeDegenerateTriangles(Primitive& primitive) {
  return filterTriangles(primitive.indices, [&](size_t t) {
    const glm::dvec3 a(primitive.positions[primitive.indices[3 * t]]);
    const glm::dvec3 b(primitive.positions[primitive.indices[3 * t + 1]]);
    const glm::dvec3 c(primitive.positions[primitive.indices[3 * t + 2]]);
    return glm::cross(b - a, c - a) != glm::dvec3(0);
  });
}

uint64_t removeDuplicateTriangles(Primitive& primitive) {
  const size_t count = primitive.indices.size() / 3;
  std::vector<std::pair<uint64_t, size_t>> byHash(count);
  for (size_t t = 0; t < count; ++t) {
    const std::array<float, 9> key = corners(primitive, t);
    byHash[t] = {hashBytes(key.data(), sizeof(key)), t};
  }
  std::sort(byHash.begin(), byHash.end());
  std::vector<bool> isDuplicate(count, false);
  bool any = false;
  for (size_t i = 1; i < count; ++i) {
    if (byHash[i].first != byHash[i - 1].first) continue;
    // Equal hashes of unequal triangles: at worst a duplicate behind such a pair stays.
    if (corners(primitive, byHash[i].second) != corners(primitive, byHash[i - 1].second)) continue;
    isDuplicate[byHash[i].second] = true;
    any = true;
  }
  if (!any) return 0;
  return filterTriangles(primitive.indices, [&](size_t t) { return !isDuplicate[t]; });
}

void removeUnusedVertices(Primitive& primitive) {
  constexpr uint32_t kUnused = ~0u;
  std::vector<uint32_t> newIndex(primitive.positions.size(), kUnused);
  for (const uint32_t index : primitive.indices) newIndex[index] = 0;
  uint32_t kept = 0;
  for (uint32_t& index : newIndex) {
    if (index != kUnused) index = kept++;
  }
  if (kept == primitive.positions.size()) return;
  const auto compact = [&](auto& values) {
    if (values.empty()) return;
    for (size_t i = 0; i < newIndex.size(); ++i) {
      if (newIndex[i] != kUnused) values[newIndex[i]] = values[i];
    }
    values.resize(kept);
    values.shrink_to_fit();
  };
  compact(primitive.positions);
  compact(primitive.normals);
  compact(primitive.tangents);
  compact(primitive.colors);
  for (auto& uvs : primitive.uvs) compact(uvs);
  for (uint32_t& index : primitive.indices) index = newIndex[index];
}

} // namespace isophote
