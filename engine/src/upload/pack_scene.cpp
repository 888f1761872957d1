#include "upload/pack_scene.hpp"

#include "upload/pack_geometry.hpp"
#include "upload/pack_lights.hpp"
#include "upload/pack_materials.hpp"

#include <algorithm>

namespace isophote {
namespace {

// Beyond this many scene radii from the origin, float positions lose digits that the scene needs; world space then
// starts at the scene's center. Nearer it is left alone, so that coordinates stay the asset's own.
constexpr double kOriginRadii = 16;

void setWorld(const Scene& scene, PackedScene& packed) {
  const Bounds bounds = worldBounds(scene);
  if (bounds.empty()) return;
  packed.worldCenter = 0.5 * bounds.lower + 0.5 * bounds.upper;
  const double radius = 0.5 * glm::length(bounds.upper - bounds.lower);
  if (radius > 0) packed.worldRadius = radius;
  if (glm::length(packed.worldCenter) > kOriginRadii * packed.worldRadius) packed.worldOrigin = packed.worldCenter;
}

// Takes out what the materials and lights announced but packing found to have no effect.
void removeUnfound(PackedScene& packed) {
  const auto isFlagged = [&](uint32_t flag) {
    return std::any_of(packed.triangles.begin(), packed.triangles.end(),
                       [flag](const gpu::BvhTriangle& triangle) { return (triangle.flags & flag) != 0; });
  };
  if (packed.features.has(Feature::kHasAlpha) && !isFlagged(gpu::kTriangleHasAlpha))
    packed.features.remove(Feature::kHasAlpha);
  if (packed.lightTree.empty()) packed.features.remove(Feature::kHasLightTree);
  if (packed.emissiveTriangles.empty()) packed.features.remove(Feature::kHasEmissiveTriangles);
  if (packed.environmentPixels.empty()) packed.features.remove(Feature::kHasEnvironment);
}

} // namespace

PackedScene packScene(const Scene& scene, Backend backend, BvhBuild bvhBuild) {
  PackedScene packed;
  packed.features = sceneFeatures(scene);
  setWorld(scene, packed);
  const std::vector<bool> meshUsed = usedMeshes(scene);
  const PackedMaterials materials = packMaterials(scene, meshUsed, packed);
  const PackedGeometry geometry = packGeometry(scene, meshUsed, materials, backend, bvhBuild, packed);
  packLights(scene, geometry, packed);
  packed.tables.facets = packed.features.has(Feature::kHasSpecular);
  packed.tables.clearcoat = packed.features.has(Feature::kHasClearcoat);
  packed.tables.sheen = packed.features.has(Feature::kHasSheen);
  packed.tables.coatedSheen = std::any_of(packed.materials.begin(), packed.materials.end(), [](const auto& material) {
    return material.clearcoat > 0 && material.sheenColor != glm::vec3(0);
  });
  removeUnfound(packed);
  return packed;
}

} // namespace isophote
