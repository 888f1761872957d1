#include "scene/vertex_repair.hpp"

#include <cmath>
#include <vector>

namespace isophote {
namespace {

/// False where v has no direction.
bool normalizeInPlace(glm::vec3& v) {
  const double length = glm::length(glm::dvec3(v));
  if (!std::isfinite(length) || length == 0) return false; // exact: any other length can be divided by
  v = glm::vec3(glm::dvec3(v) / length);
  return true;
}

} // namespace

uint64_t repairNormals(Primitive& primitive) {
  std::vector<glm::dvec3> sums;
  std::vector<bool> isBad(primitive.normals.size(), false);
  uint64_t count = 0;
  for (size_t i = 0; i < primitive.normals.size(); ++i) {
    if (normalizeInPlace(primitive.normals[i])) continue;
    isBad[i] = true;
    ++count;
  }
  if (count == 0) return 0;
  sums.assign(primitive.normals.size(), glm::dvec3(0));
  for (size_t corner = 0; corner < primitive.indices.size(); ++corner) {
    const uint32_t vertex = primitive.indices[corner];
    if (!isBad[vertex]) continue;
    const size_t first = corner / 3 * 3;
    const glm::dvec3 a(primitive.positions[primitive.indices[first]]);
    const glm::dvec3 b(primitive.positions[primitive.indices[first + 1]]);
    const glm::dvec3 c(primitive.positions[primitive.indices[first + 2]]);
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    if (sums[vertex] + normal != glm::dvec3(0)) sums[vertex] += normal; // opposite triangles: the first one decides
  }
  for (size_t i = 0; i < sums.size(); ++i) {
    if (isBad[i]) primitive.normals[i] = glm::vec3(glm::normalize(sums[i]));
  }
  return count;
}

uint64_t countBadTangents(Primitive& primitive) {
  uint64_t count = 0;
  for (glm::vec4& tangent : primitive.tangents) {
    glm::vec3 direction(tangent);
    const bool hasDirection = normalizeInPlace(direction);
    if (!hasDirection || std::abs(tangent.w) != 1.0f) ++count; // exact: glTF allows +-1 only
    tangent = glm::vec4(direction, tangent.w);
  }
  return count;
}

} // namespace isophote
