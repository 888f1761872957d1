// EXT_meshopt_compression and KHR_meshopt_compression: buffer views that are packed elsewhere.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "scene/gltf_document.hpp"

namespace isophote::gltf {

/// Either extension of a buffer view, which read alike up to what `offersMeshopt` says.
struct MeshoptExtension {
  const Json* json = nullptr; ///< null: the view is plain
  std::string pointer;
};
[[nodiscard]] MeshoptExtension meshoptExtension(const Json& view, const std::string& viewPointer);

/// Whether a buffer stands for the unpacked data without holding any.
[[nodiscard]] bool isEmptyMeshoptFallback(const Json& buffer);

/// Whether this build unpacks it: not the filter COLOR and version 1 of vertices, which the KHR extension adds.
[[nodiscard]] bool offersMeshopt(const Json& json, std::span<const std::byte> packed);

/// The bytes of the view. @throws SceneError where stream or parameters are broken, LimitError
[[nodiscard]] Bytes unpackMeshopt(Document& document, const Json& view, const MeshoptExtension& meshopt,
                                  std::span<const std::byte> packed);

} // namespace isophote::gltf
