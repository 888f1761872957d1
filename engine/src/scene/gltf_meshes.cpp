// Source: Khronos glTF 2.0.1 specification, section 3.7.2 "Meshes".
#include "scene/gltf_meshes.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "isophote/error.hpp"
#include "scene/gltf_attributes.hpp"
#include "scene/gltf_draco.hpp"
#include "scene/tangents.hpp"
#include "scene/triangle_list.hpp"
#include "scene/vertex_repair.hpp"

namespace isophote::gltf {
namespace {

constexpr uint64_t kTriangleMode = 4; ///< lower modes are points and lines

/// The vertex that restarts a primitive in other APIs; glTF forbids it.
uint32_t restartValue(ComponentType type) {
  if (type == ComponentType::UInt8) return 0xff;
  return type == ComponentType::UInt16 ? 0xffff : 0xffffffff;
}

} // namespace

std::optional<uint32_t> Meshes::use(uint32_t index, std::optional<uint32_t> skinnedNode, const Pose& pose,
                                    Scene& scene) {
  const auto [found, isNew] = used_.try_emplace({index, skinnedNode, pose.morphWeights}, std::nullopt);
  if (!isNew) return found->second;
  const Json& json = arrayOrEmpty(document_.root, "meshes")[index];
  Mesh mesh;
  mesh.name = stringOr(json, "name", "");
  const Json& primitives = json.at("primitives");
  for (size_t i = 0; i < primitives.size(); ++i) {
    const std::string pointer = fmt::format("/meshes/{}/primitives/{}", index, i);
    std::optional<Primitive> primitive = readPrimitive(primitives[i], pointer, pose, scene);
    if (primitive) mesh.primitives.push_back(std::move(*primitive));
  }
  if (mesh.primitives.empty()) return std::nullopt;
  found->second = static_cast<uint32_t>(scene.meshes.size());
  scene.meshes.push_back(std::move(mesh));
  return found->second;
}

std::optional<Primitive> Meshes::readPrimitive(const Json& json, const std::string& pointer, const Pose& pose,
                                               Scene& scene) {
  const uint64_t mode = integerOr(json, "mode", kTriangleMode);
  if (mode < kTriangleMode) {
    document_.warnings.add("points and lines are skipped", pointer);
    return std::nullopt;
  }
  if (!json.at("attributes").contains("POSITION")) {
    document_.warnings.add("a primitive without POSITION is skipped", pointer);
    return std::nullopt;
  }
  std::optional<std::vector<uint32_t>> decoded = decodeDraco(document_, buffers_, accessors_, json, pointer);
  Attributes attributes = readAttributes(document_, accessors_, json, pointer);
  Primitive& primitive = attributes.vertices;
  if (decoded) {
    requireIndicesBelow(primitive.positions.size(), *decoded, pointer + "/extensions/KHR_draco_mesh_compression");
    primitive.indices = std::move(*decoded);
  } else {
    primitive.indices = readTriangles(json, pointer, primitive.positions.size());
  }
  applyMorphTargets(document_, accessors_, json, pose, pointer, primitive);
  applySkin(document_, pose, pointer, attributes);
  clean(primitive, pointer);
  if (primitive.indices.empty()) return std::nullopt;
  assignMaterial(variants_.material(json), pointer, primitive, scene);
  return std::move(primitive);
}

std::vector<uint32_t> Meshes::readTriangles(const Json& json, const std::string& pointer, uint64_t vertexCount) {
  const uint64_t mode = integerOr(json, "mode", kTriangleMode);
  const std::vector<uint32_t> indices = readIndices(json, pointer, vertexCount);
  if (mode == kTriangleMode && indices.size() % 3 != 0) {
    document_.warnings.add("indices after the last whole triangle are left out", pointer);
  }
  return triangleList(indices, static_cast<Topology>(mode));
}

std::vector<uint32_t> Meshes::readIndices(const Json& json, const std::string& pointer, uint64_t vertexCount) {
  const std::optional<uint32_t> accessor = indexOf(json, "indices");
  if (!accessor) {
    if (vertexCount > UINT32_MAX) document_.fail(pointer, "at most 2^32 - 1 vertices");
    std::vector<uint32_t> all(vertexCount);
    std::iota(all.begin(), all.end(), 0u);
    return all;
  }
  const AccessorLayout& layout = accessors_.layout(*accessor);
  const bool isSigned = layout.componentType == ComponentType::Int8 || layout.componentType == ComponentType::Int16;
  const bool isInteger = !isSigned && layout.componentType != ComponentType::Float;
  if (layout.componentCount != 1 || !isInteger || layout.normalized || layout.hasStride) {
    document_.fail(pointer + "/indices", "an accessor of unsigned integer scalars without byteStride "
                                         "(MESH_PRIMITIVE_INDICES_ACCESSOR_INVALID_FORMAT)");
  }
  std::vector<uint32_t> indices = accessors_.readUnsigned(*accessor);
  requireIndicesBelow(vertexCount, indices, accessorPointer(*accessor), restartValue(layout.componentType));
  return indices;
}

void Meshes::requireIndicesBelow(uint64_t vertexCount, const std::vector<uint32_t>& indices, const std::string& pointer,
                                 std::optional<uint32_t> restart) const {
  for (size_t i = 0; i < indices.size(); ++i) {
    if (indices[i] < vertexCount) continue;
    document_.fail(pointer,
                   fmt::format("indices below the {} vertices, found {} at place {} ({})", vertexCount, indices[i], i,
                               indices[i] == restart ? "ACCESSOR_INDEX_PRIMITIVE_RESTART" : "ACCESSOR_INDEX_OOB"));
  }
}

void Meshes::clean(Primitive& primitive, const std::string& pointer) {
  for (const glm::vec3 p : primitive.positions) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
      document_.fail(pointer, "finite positions after morph targets and skin");
    }
  }
  document_.warnings.add("triangles without area are dropped", pointer, removeDegenerateTriangles(primitive));
  document_.warnings.add("triangles that stand there twice are dropped", pointer, removeDuplicateTriangles(primitive));
  removeUnusedVertices(primitive);
  document_.warnings.add("normals that are zero or not finite are recomputed", pointer, repairNormals(primitive));
  if (primitive.normals.empty()) primitive.tangents.clear(); // glTF: without NORMAL, TANGENT has no meaning
  const uint64_t badTangents = countBadTangents(primitive);
  document_.warnings.add("tangents that are not unit vectors with w = +-1 are recomputed", pointer, badTangents);
  if (badTangents > 0) primitive.tangents.clear();
}

void Meshes::assignMaterial(std::optional<uint32_t> material, const std::string& pointer, Primitive& primitive,
                            Scene& scene) {
  primitive.material = materials_.use(material, scene);
  const TextureRef normalTexture = scene.materials[primitive.material].normalTexture;
  if (normalTexture.present() && primitive.uvs[normalTexture.uvSet].empty()) {
    document_.warnings.add("a normal texture is left out where the mesh has no texture coordinates for it", pointer);
    primitive.material = materials_.useWithoutNormalTexture(material, scene);
  }
  fillMissingUvs(pointer, scene.materials[primitive.material], primitive);
  if (!scene.materials[primitive.material].normalTexture.present()) {
    primitive.tangents.clear(); // nothing else reads them
  } else if (primitive.tangents.empty()) {
    generateTangents(primitive, normalTexture.uvSet);
  }
}

void Meshes::fillMissingUvs(const std::string& pointer, Material& material, Primitive& primitive) {
  for (const TextureRef* ref : textureRefs(material)) {
    if (!ref->present() || !primitive.uvs[ref->uvSet].empty()) continue;
    primitive.uvs[ref->uvSet].assign(primitive.positions.size(), glm::vec2(0));
    document_.warnings.add("missing texture coordinates are taken as 0", pointer);
  }
}

} // namespace isophote::gltf
