// Vertex attributes of a glTF primitive, checked and converted to floats.
#pragma once

#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "isophote/scene.hpp"
#include "scene/gltf_accessors.hpp"
#include "scene/gltf_document.hpp"

namespace isophote::gltf {

/// Four joints and their weights a vertex; meshes with more than four joints a vertex have several of these.
struct JointSet {
  std::vector<glm::uvec4> joints;
  std::vector<glm::vec4> weights;
};

/// Displacements of one morph target; empty where the target leaves the attribute alone.
struct MorphTarget {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;
  std::vector<glm::vec3> tangents;
};

struct Attributes {
  Primitive vertices; ///< no indices and no material yet; normals not yet unit
  std::vector<JointSet> jointSets;
};

/// Kinds of numbers an attribute may be stored in, to be combined with |.
enum NumberKind : uint32_t {
  kFloat = 1,
  kSignedNormalized = 2, ///< 8 or 16 bits, as the other integers
  kUnsignedNormalized = 4,
  kSignedInteger = 8,
  kUnsignedInteger = 16,
};

/// @throws SceneError at `pointer` unless `accessor` has so many components of one of those kinds
void requireFormat(const Document& document, const Accessors& accessors, uint32_t accessor, uint32_t components,
                   uint32_t kinds, const std::string& pointer);

/// Reads POSITION, NORMAL, TANGENT, TEXCOORD_0 to 3, COLOR_0, JOINTS_n and WEIGHTS_n; others are ignored.
///
/// NaN and infinite texture coordinates and colors are replaced by 0 and 1, colors are clamped to [0, 1], each with a
/// warning. `primitive` has a POSITION.
/// @throws SceneError on formats that glTF and KHR_mesh_quantization do not allow, unequal counts, bad positions
[[nodiscard]] Attributes readAttributes(Document& document, const Accessors& accessors, const Json& primitive,
                                        const std::string& pointer);

/// Reads one entry of primitive.targets. @throws SceneError
[[nodiscard]] MorphTarget readMorphTarget(const Document& document, const Accessors& accessors, const Json& target,
                                          size_t vertexCount, const std::string& pointer);

} // namespace isophote::gltf
