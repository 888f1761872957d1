// Encoders for the compressed forms of glTF, so that tests need no files.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace isophote::test {

struct CompressibleMesh {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;
  std::vector<glm::vec2> uvs;
  std::vector<uint32_t> indices; ///< three a triangle
};

enum class DracoMethod { Sequential, Edgebreaker };

/// Unique ids in the stream.
inline constexpr uint32_t kDracoPosition = 0;
inline constexpr uint32_t kDracoNormal = 1;
inline constexpr uint32_t kDracoUv = 2;

struct DracoStream {
  std::string bytes;
  size_t points = 0;
  size_t faces = 0;
};

/// Positions in 14 bits of the largest side, normals in 10, texture coordinates in 12. Needs libdraco.
[[nodiscard]] DracoStream encodeDraco(const CompressibleMesh& mesh, DracoMethod method);

// Need meshoptimizer.
[[nodiscard]] std::string encodeMeshoptVertices(const std::string& elements, size_t stride);
[[nodiscard]] std::string encodeMeshoptTriangles(const std::vector<uint32_t>& indices, size_t vertexCount);
[[nodiscard]] std::string encodeMeshoptIndices(const std::vector<uint32_t>& indices, size_t vertexCount);
/// Four signed bytes a vector, three used.
[[nodiscard]] std::string filterOctahedral(const std::vector<glm::vec4>& unitVectors);
/// Four signed 16-bit numbers a quaternion (x, y, z, w).
[[nodiscard]] std::string filterQuaternion(const std::vector<glm::vec4>& quaternions);
/// Three floats a vector, 15 bits of mantissa.
[[nodiscard]] std::string filterExponential(const std::vector<glm::vec3>& vectors);

/// Lossless. Needs libwebp.
[[nodiscard]] std::string encodeWebp(uint32_t width, uint32_t height, const std::string& rgba);

} // namespace isophote::test
