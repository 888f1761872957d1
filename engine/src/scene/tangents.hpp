// Tangent frames for normal maps.
#pragma once

#include "isophote/scene.hpp"

namespace isophote {

/// Fills `tangents` of a primitive from its positions, normals and one UV set; vertices that need different tangents
/// in different triangles are split, which renumbers `indices` and lengthens every attribute array.
///
/// Follows MikkTSpace: corners that share position, normal, uv and the orientation of their uv triangle share a
/// tangent, the angle-weighted mean of their triangles' u directions in the plane of the normal. Triangles without uv
/// area take the tangent of their neighbors, or any direction in the plane. With no normals, that of each triangle is
/// used. w = +-1 makes cross(normal, tangent) * w point against v: glTF's v runs down the image, its normal maps' y up.
///
/// Source: Mikkelsen 2008, "Simulation of Wrinkled Surfaces Revisited", chapter 4, and his mikktspace.c.
/// @param uvSet  below kMaxUvSets; uvs[uvSet] is not empty
void generateTangents(Primitive& primitive, uint32_t uvSet);

} // namespace isophote
