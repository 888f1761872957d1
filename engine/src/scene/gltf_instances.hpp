// Mesh nodes to instances: plain, skinned, or many at once by EXT_mesh_gpu_instancing.
#pragma once

#include <vector>

#include "isophote/scene.hpp"
#include "scene/gltf_accessors.hpp"
#include "scene/gltf_document.hpp"
#include "scene/gltf_meshes.hpp"
#include "scene/gltf_nodes.hpp"

namespace isophote::gltf {

/// Adds an instance for each visible node with triangles, and the meshes and materials they need.
/// @throws SceneError; LimitError where there are more than LoadOptions::maxNodes instances
void addInstances(Document& document, const Accessors& accessors, const NodeGraph& graph,
                  const std::vector<PlacedNode>& nodes, Meshes& meshes, Scene& scene);

} // namespace isophote::gltf
