// Light records, the order of light indices, and how likely each light is to be sampled.
#pragma once

#include "upload/pack_geometry.hpp"
#include "upload/pack_scene.hpp"

namespace isophote {

/// Fills emissive triangles, punctual lights, environment, alias table, emitterScale, and firstEmitter of the
/// instances.
/// @throws LimitError where a light index would overflow
void packLights(const Scene& scene, const PackedGeometry& geometry, PackedScene& packed);

} // namespace isophote
