// Index lists: strips and fans to triangles, and what has to go before a primitive can be traced.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "isophote/scene.hpp"

namespace isophote {

enum class Topology : uint32_t { Triangles = 4, Strip = 5, Fan = 6 }; ///< glTF's primitive modes

/// Indices as a triangle list with glTF's winding (section 3.7.2.1); a tail that makes no triangle is left out.
[[nodiscard]] std::vector<uint32_t> triangleList(const std::vector<uint32_t>& indices, Topology topology);

/// Removes triangles without area: repeated vertices, or collinear ones in double precision. Returns how many.
uint64_t removeDegenerateTriangles(Primitive& primitive);

/// Removes all but the first of triangles with equal corner positions and winding. Returns how many.
///
/// Two lights in one place would be counted twice by light sampling, but a path meets only one of them.
uint64_t removeDuplicateTriangles(Primitive& primitive);

/// Removes vertices that no triangle uses; the others keep their order.
void removeUnusedVertices(Primitive& primitive);

} // namespace isophote
