// The KHR_materials_* extensions of a glTF material.
#pragma once

#include "scene/gltf_material_properties.hpp"

namespace isophote::gltf {

/// Reads the extensions of material `json` that change how its surface or its volume scatters.
void readMaterialExtensions(MaterialProperties& properties, const Json& json, Material& material);

} // namespace isophote::gltf
