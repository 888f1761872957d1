// Scene -> flat arrays of the shared structs. No device needed, so testable anywhere.
#pragma once

#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "isophote/features.hpp"
#include "isophote/scene.hpp"
#include "isophote/settings.hpp"
#include "shared/geometry_types.h"
#include "shared/light_types.h"
#include "shared/material_types.h"
#include "upload/scattering_tables.hpp"

namespace isophote {

/// One entry of the texture array: an image of the Scene, how it is sampled, and how it is decoded.
struct PackedTexture {
  uint32_t image = 0;
  Wrap wrapS = Wrap::Repeat;
  Wrap wrapT = Wrap::Repeat;
  Filter filter = Filter::Linear;
  bool srgb = false;
};

struct BvhStatistics {
  uint64_t triangles = 0; ///< stored once, however often instanced
  uint64_t instancedTriangles = 0;
  uint64_t nodes = 0;
  double sahCost = 0;    ///< of the top level plus its instances' mesh BVHs, area-weighted
  uint32_t maxDepth = 0; ///< top level plus the deepest mesh
  double milliseconds = 0;
};

/// Triangles that form one geometry of a bottom-level acceleration structure.
struct TriangleRange {
  uint32_t count = 0;
  uint32_t mesh = 0;  ///< as InstanceRecord::mesh
  bool opaque = true; ///< none of them calls the alpha test
};

/// Everything GpuScene uploads. Arrays a scene does not need are empty.
struct PackedScene {
  std::vector<gpu::BvhNode> nodes;
  std::vector<gpu::BvhTriangle> triangles;
  std::vector<uint32_t>
      meshTriangles; ///< where the triangles of InstanceRecord::mesh begin, and where the last ones end
  std::vector<TriangleRange> triangleRanges; ///< of Backend::RayQuery: by mesh; those that call the alpha test last
  std::vector<uint32_t> rangeStarts;         ///< the first triangle of each range
  std::vector<gpu::InstanceRecord> instances;
  std::vector<gpu::Geometry> geometries;
  std::vector<uint32_t> indices;
  std::vector<glm::vec3> normals;
  std::vector<glm::vec4> tangents;
  std::vector<glm::vec4> colors;
  std::vector<glm::vec2> uvs;
  std::vector<gpu::MaterialRecord> materials;
  std::vector<std::string> materialNames; ///< of `materials`
  std::vector<gpu::TextureSlot> textureSlots;
  std::vector<PackedTexture> textures;
  std::vector<gpu::AliasEntry> lightAlias;
  std::vector<gpu::LightTreeNode> lightTree;
  std::vector<uint32_t> lightTrails;
  float lightTreeScale = 1;
  std::vector<gpu::EmissiveTriangle> emissiveTriangles;
  std::vector<gpu::PunctualLightRecord> punctualLights; ///< suns first, otherwise as Scene::lights
  uint32_t sunCount = 0;
  std::vector<glm::vec3> environmentPixels;
  std::vector<float> environmentMarginal;
  std::vector<float> environmentConditional;
  uint32_t environmentWidth = 0;
  uint32_t environmentHeight = 0;
  float environmentCosRotation = 1;
  float environmentSinRotation = 0;
  TableNeeds tables;
  glm::dvec3 worldOrigin{0}; ///< subtracted from every world position before rounding to float
  glm::dvec3 worldCenter{0}; ///< of the bounds, absolute
  double worldRadius = 1;    ///< half diagonal of the bounds; 1 for an empty scene
  float emitterScale = 1;    ///< power of two at or above the largest radiance that a camera path can meet in one event
  FeatureSet features;
  BvhStatistics bvh;
};

/// @param backend  RayQuery: no BVH; triangles in the order of the ranges, instances in that of the Scene
/// @throws LimitError where a 32-bit index of the device format would overflow
[[nodiscard]] PackedScene packScene(const Scene& scene, Backend backend = Backend::Compute,
                                    BvhBuild bvhBuild = BvhBuild::FastTrace);

} // namespace isophote
