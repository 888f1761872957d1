// Topologies, and what is repaired or dropped before a primitive is traced.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "unit/gltf_asset.hpp"

using namespace isophote;
using namespace isophote::test;

namespace {

/// A unit square in z = 0: 0 (0,0), 1 (1,0), 2 (1,1), 3 (0,1).
GltfAsset squareAsset(const std::vector<uint16_t>& indices, int mode = 4) {
  GltfAsset asset = triangleAsset();
  asset.attribute("POSITION") = asset.addFloats({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3");
  asset.primitive()["indices"] = asset.addIndices(indices);
  asset.primitive()["mode"] = mode;
  return asset;
}

std::vector<uint32_t> indicesOf(const Scene& scene) { return scene.meshes.at(0).primitives.at(0).indices; }

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

} // namespace

TEST(GltfMeshes, StripsBecomeTrianglesOfOneWinding) {
  // glTF 3.7.2.1: p_i = {v_i, v_(i + (1 + i % 2)), v_(i + (2 - i % 2))}
  EXPECT_EQ(indicesOf(load(squareAsset({0, 1, 3, 2}, 5))), (std::vector<uint32_t>{0, 1, 3, 1, 2, 3}));
}

TEST(GltfMeshes, FansBecomeTrianglesAroundTheFirstVertex) {
  // glTF 3.7.2.1: p_i = {v_(i+1), v_(i+2), v_0}
  EXPECT_EQ(indicesOf(load(squareAsset({0, 1, 2, 3}, 6))), (std::vector<uint32_t>{1, 2, 0, 2, 3, 0}));
}

TEST(GltfMeshes, PointsAndLinesAreSkippedWithOneWarning) {
  GltfAsset asset = squareAsset({0, 1, 2});
  for (int mode = 0; mode < 4; ++mode) {
    Json primitive = asset.primitive();
    primitive["mode"] = mode;
    asset.json["meshes"][0]["primitives"].push_back(primitive);
  }
  const Scene scene = load(asset);
  EXPECT_EQ(scene.meshes.at(0).primitives.size(), 1u);
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_EQ(scene.warnings[0], "points and lines are skipped (4 times, first at /meshes/0/primitives/1)");
}

TEST(GltfMeshes, AMeshWithoutTrianglesMakesNoInstance) {
  const Scene scene = load(squareAsset({0, 1, 2}, 0));
  EXPECT_TRUE(scene.meshes.empty());
  EXPECT_TRUE(scene.instances.empty());
  EXPECT_TRUE(worldBounds(scene).empty());
}

TEST(GltfMeshes, ATailOfIndicesIsLeftOut) {
  const Scene scene = load(squareAsset({0, 1, 2, 0, 2}));
  EXPECT_EQ(indicesOf(scene).size(), 3u);
  EXPECT_TRUE(warns(scene, "after the last whole triangle"));
}

TEST(GltfMeshes, TrianglesWithoutAreaAreDroppedAndCounted) {
  GltfAsset asset = squareAsset({0, 1, 2, 0, 0, 2, 0, 4, 5, 2, 3, 0});
  asset.attribute("POSITION") =
      asset.addFloats({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0.25f, 0.25f, 0, 0.5f, 0.5f, 0}, "VEC3");
  const Scene scene = load(asset);
  EXPECT_EQ(indicesOf(scene), (std::vector<uint32_t>{0, 1, 2, 2, 3, 0}));
  EXPECT_EQ(scene.meshes[0].primitives[0].positions.size(), 4u) << "unused vertices go as well";
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_EQ(scene.warnings[0], "triangles without area are dropped (2 times, first at /meshes/0/primitives/0)");
}

TEST(GltfMeshes, AThinTriangleIsNotDegenerate) {
  GltfAsset asset = triangleAsset();
  asset.attribute("POSITION") = asset.addFloats({0, 0, 0, 1, 0, 0, 1, 1e-30f, 0}, "VEC3");
  EXPECT_EQ(indicesOf(load(asset)).size(), 3u);
}

TEST(GltfMeshes, RepeatedTrianglesAreDroppedWhateverCornerTheyStartWith) {
  // The second repeats the first by other vertices at the same places; the third is its back side and stays.
  GltfAsset asset = squareAsset({0, 1, 2, 6, 4, 5, 2, 1, 0});
  asset.attribute("POSITION") =
      asset.addFloats({0, 0, 0, 1, 0, 0, 1, 1, 0, 9, 9, 9, -0.0f, 0, 0, 1, 0, 0, 1, 1, 0}, "VEC3");
  asset.primitive()["indices"] = asset.addIndices({0, 1, 2, 5, 6, 4, 2, 1, 0});
  const Scene scene = load(asset);
  EXPECT_EQ(indicesOf(scene), (std::vector<uint32_t>{0, 1, 2, 2, 1, 0}));
  EXPECT_TRUE(warns(scene, "triangles that stand there twice are dropped"));
}

TEST(GltfMeshes, NormalsAreMadeUnit) {
  GltfAsset asset = triangleAsset();
  asset.attribute("NORMAL") = asset.addFloats({0, 0, 3, 0, 3, 4, 1e-30f, 0, 0}, "VEC3");
  const Scene scene = load(asset);
  const std::vector<glm::vec3>& normals = scene.meshes[0].primitives[0].normals;
  EXPECT_EQ(normals[0], glm::vec3(0, 0, 1));
  EXPECT_FLOAT_EQ(normals[1].y, 0.6f);
  EXPECT_FLOAT_EQ(normals[1].z, 0.8f);
  EXPECT_EQ(normals[2], glm::vec3(1, 0, 0));
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(GltfMeshes, BadNormalsBecomeFlatOnesWithOneWarning) {
  GltfAsset asset = triangleAsset();
  asset.attribute("NORMAL") = asset.addFloats({0, 0, 0, kNan, 0, 1, 1, 0, 0}, "VEC3");
  const Scene scene = load(asset);
  EXPECT_EQ(scene.meshes[0].primitives[0].normals, (std::vector<glm::vec3>{{0, 0, 1}, {0, 0, 1}, {1, 0, 0}}));
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_EQ(scene.warnings[0],
            "normals that are zero or not finite are recomputed (2 times, first at /meshes/0/primitives/0)");
}

TEST(GltfMeshes, ABadNormalBetweenOppositeTrianglesStillGetsADirection) {
  GltfAsset asset = squareAsset({0, 1, 2, 0, 2, 1});
  asset.attribute("NORMAL") = asset.addFloats(std::vector<float>(12, 0.0f), "VEC3");
  const Scene scene = load(asset);
  for (const glm::vec3 normal : scene.meshes[0].primitives[0].normals) EXPECT_EQ(normal, glm::vec3(0, 0, 1));
}

TEST(GltfMeshes, BadTextureCoordinatesAndColorsAreReplaced) {
  GltfAsset asset = triangleAsset();
  asset.attribute("TEXCOORD_0") = asset.addFloats({kNan, 1, 1, 0, 0, 1}, "VEC2");
  asset.attribute("COLOR_0") = asset.addFloats({kNan, 0, 0, 2, -1, 0.5f, 0, 1, 0}, "VEC3");
  const Scene scene = load(asset);
  const Primitive& primitive = scene.meshes[0].primitives[0];
  EXPECT_EQ(primitive.uvs[0][0], glm::vec2(0, 0));
  EXPECT_EQ(primitive.colors[0], glm::vec4(1));
  EXPECT_EQ(primitive.colors[1], glm::vec4(1, 0, 0.5f, 1));
  EXPECT_EQ(scene.warnings.size(), 3u);
}

TEST(GltfMeshes, UnusedVerticesAreDroppedFromEveryAttribute) {
  GltfAsset asset = squareAsset({1, 2, 3});
  asset.attribute("TEXCOORD_0") = asset.addFloats({0, 0, 1, 0, 2, 0, 3, 0}, "VEC2");
  const Scene scene = load(asset);
  const Primitive& primitive = scene.meshes[0].primitives[0];
  EXPECT_EQ(primitive.indices, (std::vector<uint32_t>{0, 1, 2}));
  EXPECT_EQ(primitive.positions[0], glm::vec3(1, 0, 0));
  EXPECT_EQ(primitive.uvs[0], (std::vector<glm::vec2>{{1, 0}, {2, 0}, {3, 0}}));
}

TEST(GltfMeshes, APrimitiveWithoutPositionsIsSkipped) {
  GltfAsset asset = triangleAsset();
  asset.json["meshes"][0]["primitives"].push_back({{"attributes", {{"NORMAL", 0}}}});
  const Scene scene = load(asset);
  EXPECT_EQ(scene.meshes[0].primitives.size(), 1u);
  EXPECT_TRUE(warns(scene, "without POSITION"));
}

TEST(GltfMeshes, ManyNodesShareOneMesh) {
  GltfAsset asset = triangleAsset();
  asset.json["nodes"] = {{{"mesh", 0}}, {{"mesh", 0}, {"translation", {1, 0, 0}}}};
  asset.json["scenes"] = {{{"nodes", {0, 1}}}};
  const Scene scene = load(asset);
  EXPECT_EQ(scene.meshes.size(), 1u);
  EXPECT_EQ(scene.instances.size(), 2u);
}
