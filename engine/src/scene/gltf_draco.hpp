// KHR_draco_mesh_compression: primitives whose vertices and indices are packed in one stream.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scene/gltf_accessors.hpp"
#include "scene/gltf_buffers.hpp"
#include "scene/gltf_document.hpp"

namespace isophote::gltf {

/// Decodes the stream of a primitive into its accessors, which are read like any others from then on.
///
/// @return  the triangles, three indices each, not yet checked; nothing where the primitive is plain, or where this
/// build
///          has no Draco and the accessors hold the data as well
/// @throws SceneError where the stream is broken or contradicts the accessors; UnsupportedError, LimitError
[[nodiscard]] std::optional<std::vector<uint32_t>> decodeDraco(Document& document, const Buffers& buffers,
                                                               Accessors& accessors, const Json& primitive,
                                                               const std::string& pointer);

} // namespace isophote::gltf
