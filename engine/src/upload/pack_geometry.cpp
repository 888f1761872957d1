#include "upload/pack_geometry.hpp"

#include "isophote/error.hpp"
#include "upload/mesh_groups.hpp"
#include "upload/pack_bvh.hpp"
#include "upload/pack_instances.hpp"
#include "upload/pack_texels.hpp"
#include "upload/place_order.hpp"

#include <algorithm>
#include <map>
#include <string>

namespace isophote {
namespace {

// Indices of nodes and triangles are 32-bit words.
constexpr uint64_t kMaxTraversalItems = (1ull << 31) - 1;

void requireFits(uint64_t count, uint64_t limit, const char* what) {
  if (count <= limit) return;
  throw LimitError("the scene has " + std::to_string(count) + " " + what + "; the device format holds at most " +
                   std::to_string(limit));
}

// Appends values and returns where they start, kInvalidIndex where there are none.
template <class T> uint32_t append(std::vector<T>& all, const std::vector<T>& values, bool wanted, const char* what) {
  if (values.empty() || !wanted) return gpu::kInvalidIndex;
  const auto first = static_cast<uint32_t>(all.size());
  requireFits(all.size() + values.size(), gpu::kInvalidIndex, what);
  all.insert(all.end(), values.begin(), values.end());
  return first;
}

class MeshPacker {
public:
  MeshPacker(const Scene& scene, const PackedMaterials& materials, Backend backend, BvhBuild bvhBuild,
             PackedScene& packed)
      : scene_(scene), materials_(materials), backend_(backend), bvhBuild_(bvhBuild), packed_(packed) {}

  // Appends the meshes of a group; their BVH nodes go to `nodes` with indices relative to that array.
  PackedMesh add(const MeshGroup& group, std::vector<gpu::BvhNode>& nodes) {
    PackedMesh result;
    std::vector<gpu::BvhTriangle> triangles;
    uint32_t emissive = 0;
    for (const uint32_t mesh : group.meshes) {
      for (uint32_t i = 0; i < scene_.meshes[mesh].primitives.size(); ++i) {
        const Primitive& primitive = scene_.meshes[mesh].primitives[i];
        if (primitive.indices.empty()) continue;
        gpu::Geometry geometry = attributes(primitive);
        const uint32_t flags = triangleFlags(primitive);
        if (flags & gpu::kTriangleEmissive) {
          geometry.firstEmissive = emissive;
          emissive += static_cast<uint32_t>(primitive.indices.size() / 3);
        }
        addTriangles(primitive, flags, triangles);
        packed_.geometries.push_back(geometry);
        sources_.push_back({mesh, i});
      }
    }
    if (triangles.empty()) return result;
    result.triangleCount = static_cast<uint32_t>(triangles.size());
    if (backend_ == Backend::RayQuery) {
      listRanges(triangles);
    } else {
      buildTree(triangles, result, nodes);
    }
    result.emitters = emitters(emissive, result);
    return result;
  }

private:
  // A primitive of the Scene.
  struct Source {
    uint32_t mesh, primitive;
  };

  gpu::Geometry attributes(const Primitive& primitive) {
    const Material& material = scene_.materials[primitive.material];
    const uint32_t uvSets = materials_.uvSets[primitive.material];
    gpu::Geometry geometry{};
    geometry.firstNormal = append(packed_.normals, primitive.normals, true, "normals");
    geometry.firstTangent =
        append(packed_.tangents, primitive.tangents, tangentUvSet(material).has_value(), "tangents");
    geometry.firstColor = append(packed_.colors, primitive.colors, true, "vertex colors");
    bool any = !primitive.normals.empty() || geometry.firstTangent != gpu::kInvalidIndex || !primitive.colors.empty();
    for (uint32_t set = 0; set < kMaxUvSets; ++set) {
      geometry.firstUv[set] = append(packed_.uvs, primitive.uvs[set], uvSets >> set & 1u, "texture coordinates");
      any = any || geometry.firstUv[set] != gpu::kInvalidIndex;
    }
    geometry.firstIndex = append(packed_.indices, primitive.indices, any, "indices");
    geometry.material = materials_.record[primitive.material];
    geometry.firstEmissive = gpu::kInvalidIndex;
    return geometry;
  }

  void addTriangles(const Primitive& primitive, uint32_t flags, std::vector<gpu::BvhTriangle>& triangles) const {
    const auto geometry = static_cast<uint32_t>(packed_.geometries.size());
    for (uint32_t i = 0; i < primitive.indices.size() / 3; ++i) {
      const uint32_t* corner = &primitive.indices[3 * static_cast<size_t>(i)];
      triangles.push_back({primitive.positions[corner[0]], i, primitive.positions[corner[1]], geometry,
                           primitive.positions[corner[2]], flags});
    }
  }

  void buildTree(const std::vector<gpu::BvhTriangle>& triangles, PackedMesh& mesh, std::vector<gpu::BvhNode>& nodes) {
    std::vector<Box> boxes(triangles.size());
    for (size_t i = 0; i < triangles.size(); ++i) {
      for (const glm::vec3& v : {triangles[i].v0, triangles[i].v1, triangles[i].v2}) boxes[i].grow(v);
    }
    WideBvh bvh = buildTimedBvh(boxes, gpu::kBvhItemsPerSlot, bvhBuild_, packed_.bvh);
    const auto firstTriangle = static_cast<uint32_t>(packed_.triangles.size());
    mesh.rootNode = static_cast<uint32_t>(nodes.size());
    mesh.maxDepth = bvh.maxDepth;
    mesh.sahCost = bvh.sahCost;
    mesh.bounds = bvh.bounds;
    for (gpu::BvhNode& node : bvh.nodes) {
      node.firstChild += mesh.rootNode;
      node.firstItem += firstTriangle;
    }
    nodes.insert(nodes.end(), bvh.nodes.begin(), bvh.nodes.end());
    for (const uint32_t item : bvh.order) packed_.triangles.push_back(triangles[item]);
  }

  // Opaque triangles first, so that the device need not ask about them; each range in an order that builders like.
  void listRanges(std::vector<gpu::BvhTriangle>& triangles) {
    const auto isOpaque = [](const gpu::BvhTriangle& triangle) {
      return (triangle.flags & gpu::kTriangleHasAlpha) == 0;
    };
    const auto first = static_cast<uint32_t>(packed_.triangles.size());
    const auto mesh = static_cast<uint32_t>(packed_.meshTriangles.size() - 1);
    const auto firstWithAlpha = std::stable_partition(triangles.begin(), triangles.end(), isOpaque);
    sortByPlace({triangles.begin(), firstWithAlpha});
    sortByPlace({firstWithAlpha, triangles.end()});
    const auto opaque = static_cast<uint32_t>(firstWithAlpha - triangles.begin());
    const auto others = static_cast<uint32_t>(triangles.end() - firstWithAlpha);
    const auto add = [&](uint32_t start, uint32_t count, bool withoutAlpha) {
      if (count == 0) return;
      packed_.triangleRanges.push_back({count, mesh, withoutAlpha});
      packed_.rangeStarts.push_back(start);
    };
    add(first, opaque, true);
    add(first + opaque, others, false);
    packed_.triangles.insert(packed_.triangles.end(), triangles.begin(), triangles.end());
  }

  // Emitters in the order of light indices, from the mesh's triangles in any order.
  [[nodiscard]] std::vector<MeshEmitter> emitters(uint32_t count, const PackedMesh& mesh) const {
    std::vector<MeshEmitter> result(count);
    const size_t first = packed_.triangles.size() - mesh.triangleCount;
    for (size_t i = first; count > 0 && i < packed_.triangles.size(); ++i) {
      const gpu::BvhTriangle& triangle = packed_.triangles[i];
      if (!(triangle.flags & gpu::kTriangleEmissive)) continue;
      const uint32_t at = packed_.geometries[triangle.geometry].firstEmissive + triangle.primitiveIndex;
      const Source& source = sources_[triangle.geometry];
      result[at] = {static_cast<uint32_t>(i), source.mesh, source.primitive, triangle.primitiveIndex};
    }
    return result;
  }

  uint32_t triangleFlags(const Primitive& primitive) {
    const Material& material = scene_.materials[primitive.material];
    return (isCertainlyOpaque(material, primitive) ? 0 : gpu::kTriangleHasAlpha) |
           (isEmitter(material) ? gpu::kTriangleEmissive : 0);
  }

  // Whether alpha is 1 wherever the primitive can be hit.
  bool isCertainlyOpaque(const Material& material, const Primitive& primitive) {
    if (material.alphaMode == AlphaMode::Opaque) return true;
    if (material.alphaMode == AlphaMode::Mask && material.alphaCutoff > 1) return false;
    if (material.baseColor.a < 1) return false;
    for (const glm::vec4& color : primitive.colors) {
      if (color.a < 1) return false;
    }
    if (!material.baseColorTexture.present()) return true;
    const uint32_t image = scene_.textures[static_cast<size_t>(material.baseColorTexture.texture)].image;
    const auto [entry, isNew] = opaqueImages_.try_emplace(image, false);
    if (isNew) entry->second = isOpaqueImage(scene_.images[image]);
    return entry->second;
  }

  const Scene& scene_;
  const PackedMaterials& materials_;
  Backend backend_;
  BvhBuild bvhBuild_;
  PackedScene& packed_;
  std::vector<Source> sources_; // of packed_.geometries
  std::map<uint32_t, bool> opaqueImages_;
};

void requireTriangleIndices(const Scene& scene, const std::vector<bool>& meshUsed) {
  uint64_t triangles = 0;
  for (size_t i = 0; i < scene.meshes.size(); ++i) {
    if (!meshUsed[i]) continue;
    for (const Primitive& primitive : scene.meshes[i].primitives) triangles += primitive.indices.size() / 3;
  }
  // A tree over n leaves has fewer inner nodes, and the top level adds fewer than one per instance.
  requireFits(triangles, kMaxTraversalItems / 2, "triangles");
  requireFits(scene.instances.size() + scene.lights.size(), kMaxTraversalItems / 4, "instances and lights");
}

} // namespace

std::vector<bool> usedMeshes(const Scene& scene) {
  std::vector<bool> used(scene.meshes.size(), false);
  for (const Instance& instance : scene.instances) used[instance.mesh] = true;
  return used;
}

PackedGeometry packGeometry(const Scene& scene, const std::vector<bool>& meshUsed, const PackedMaterials& materials,
                            Backend backend, BvhBuild bvhBuild, PackedScene& packed) {
  requireTriangleIndices(scene, meshUsed);
  PackedGeometry result;
  const MeshGroups groups = groupMeshes(scene);
  std::vector<gpu::BvhNode> meshNodes;
  MeshPacker packer(scene, materials, backend, bvhBuild, packed);
  for (const MeshGroup& group : groups.groups) {
    packed.meshTriangles.push_back(static_cast<uint32_t>(packed.triangles.size()));
    result.meshes.push_back(packer.add(group, meshNodes));
  }
  packed.meshTriangles.push_back(static_cast<uint32_t>(packed.triangles.size()));
  result.sceneInstances = packInstances(scene, groups.placements, result.meshes, backend, bvhBuild, packed);
  const auto topNodes = static_cast<uint32_t>(packed.nodes.size());
  for (gpu::BvhNode& node : meshNodes) node.firstChild += topNodes;
  packed.nodes.insert(packed.nodes.end(), meshNodes.begin(), meshNodes.end());
  packed.bvh.triangles = packed.triangles.size();
  packed.bvh.nodes = packed.nodes.size();
  return result;
}

} // namespace isophote
