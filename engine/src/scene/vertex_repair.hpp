// Normals and tangents made fit for shading.
#pragma once

#include <cstdint>

#include "isophote/scene.hpp"

namespace isophote {

/// Makes normals unit. NaN, infinite and zero ones take the area-weighted normal of the triangles around the vertex,
/// which for an unshared vertex is the flat one. `indices` are set, no triangle is degenerate. Returns how many.
uint64_t repairNormals(Primitive& primitive);

/// Makes tangents unit and w +-1. Returns how many are NaN, infinite or zero, or have another w: then none can be
/// trusted.
uint64_t countBadTangents(Primitive& primitive);

} // namespace isophote
