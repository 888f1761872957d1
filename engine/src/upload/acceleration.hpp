// The device's acceleration structures of a packed scene.
#pragma once

#include "gpu/acceleration_structures.hpp"
#include "upload/pack_scene.hpp"

namespace isophote {

/// A bottom level for each mesh, with its ranges as geometries; one for all sphere lights, in world space. The top
/// level has the packed instances in their order, but one at the end for all spheres: box b of it is record
/// (instances of meshes) + b. The custom index of an instance is the number of its mesh's first range.
///
/// @param packed     of Backend::RayQuery
/// @param triangles  device address of PackedScene::triangles
[[nodiscard]] gpu::AccelerationStructures buildAcceleration(const Device& device, const PackedScene& packed,
                                                            gpu::Address triangles);

} // namespace isophote
