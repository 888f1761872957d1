// Morph targets and skins in the static pose.
#include <gtest/gtest.h>

#include "isophote/error.hpp"
#include "unit/gltf_asset.hpp"

using namespace isophote;
using namespace isophote::test;

namespace {

/// Target 0 moves the second vertex by (1,0,0); target 1 the third by (0,2,0) and all normals by (0,3,0).
GltfAsset morphedAsset() {
  GltfAsset asset = triangleAsset();
  asset.attribute("NORMAL") = asset.addFloats({0, 0, 4, 0, 0, 4, 0, 0, 4}, "VEC3");
  const size_t first = asset.addFloats({0, 0, 0, 1, 0, 0, 0, 0, 0}, "VEC3");
  const size_t second = asset.addFloats({0, 0, 0, 0, 0, 0, 0, 2, 0}, "VEC3");
  const size_t normals = asset.addFloats({0, 3, 0, 0, 3, 0, 0, 3, 0}, "VEC3");
  asset.primitive()["targets"] = {{{"POSITION", first}}, {{"POSITION", second}, {"NORMAL", normals}}};
  return asset;
}

/// Two joints: node 1 at the origin, node 2 moved up by 10; the vertices follow joints 0, 1 and half of each.
GltfAsset skinnedAsset() {
  GltfAsset asset = triangleAsset();
  asset.attribute("JOINTS_0") = asset.addAccessor<uint8_t>({0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}, kUInt8, "VEC4");
  asset.attribute("WEIGHTS_0") = asset.addFloats({1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 0, 0}, "VEC4");
  asset.json["nodes"] = {
      {{"mesh", 0}, {"skin", 0}, {"translation", {100, 0, 0}}}, {{"children", {2}}}, {{"translation", {0, 10, 0}}}};
  asset.json["scenes"] = {{{"nodes", {0, 1}}}};
  asset.json["skins"] = {{{"joints", {1, 2}}}};
  return asset;
}

std::vector<glm::dvec3> worldPositions(const Scene& scene) {
  const Instance& instance = scene.instances.at(0);
  std::vector<glm::dvec3> result;
  for (const glm::vec3 p : scene.meshes.at(instance.mesh).primitives.at(0).positions) {
    result.emplace_back(instance.worldFromObject * glm::dvec4(p, 1));
  }
  return result;
}

} // namespace

TEST(GltfPose, WithoutWeightsMorphTargetsAreOff) {
  const Scene scene = load(morphedAsset());
  EXPECT_EQ(worldPositions(scene)[2], glm::dvec3(0, 1, 0));
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(GltfPose, MorphWeightsMovePositionsAndNormals) {
  GltfAsset asset = morphedAsset();
  asset.json["meshes"][0]["weights"] = {0.5, 1};
  const Scene scene = load(asset);
  EXPECT_EQ(worldPositions(scene)[1], glm::dvec3(1.5, 0, 0));
  EXPECT_EQ(worldPositions(scene)[2], glm::dvec3(0, 3, 0));
  EXPECT_EQ(scene.meshes[0].primitives[0].normals[0], glm::vec3(0, 0.6f, 0.8f));
}

TEST(GltfPose, WeightsOfTheNodeReplaceThoseOfTheMesh) {
  GltfAsset asset = morphedAsset();
  asset.json["meshes"][0]["weights"] = {1, 0};
  asset.json["nodes"] = {{{"mesh", 0}, {"weights", {0, 0.5}}}, {{"mesh", 0}}, {{"mesh", 0}, {"weights", {1}}}};
  asset.json["scenes"] = {{{"nodes", {0, 1, 2}}}};
  const Scene scene = load(asset);
  EXPECT_EQ(worldPositions(scene)[2], glm::dvec3(0, 2, 0));
  EXPECT_EQ(scene.meshes.size(), 2u) << "equal poses share a mesh";
  EXPECT_EQ(scene.instances[1].mesh, scene.instances[2].mesh);
}

TEST(GltfPose, AMorphTargetOfAnotherLengthIsRefused) {
  GltfAsset asset = morphedAsset();
  asset.json["meshes"][0]["weights"] = {1, 0};
  asset.primitive()["targets"][0]["POSITION"] = asset.addFloats({0, 0, 0}, "VEC3");
  EXPECT_THROW((void)load(asset), SceneError);
}

TEST(GltfPose, SkinsFollowTheirJointsAndIgnoreTheirNode) {
  const Scene scene = load(skinnedAsset());
  const std::vector<glm::dvec3> positions = worldPositions(scene);
  EXPECT_EQ(positions[0], glm::dvec3(0, 0, 0));
  EXPECT_EQ(positions[1], glm::dvec3(1, 10, 0));
  EXPECT_EQ(positions[2], glm::dvec3(0, 6, 0)) << "weights 1 and 1 are normalized";
}

TEST(GltfPose, InverseBindMatricesComeFirst) {
  GltfAsset asset = skinnedAsset();
  std::vector<float> matrices(32, 0.0f);
  for (size_t i = 0; i < 32; i += 5) matrices[i < 16 ? i : i + 0] = 0;
  for (size_t m = 0; m < 2; ++m) {
    for (size_t i = 0; i < 4; ++i) matrices[16 * m + 5 * i] = 1;
  }
  matrices[16 + 13] = -10; // joint 1 is bound where it stands
  asset.json["skins"][0]["inverseBindMatrices"] = asset.addFloats(matrices, "MAT4");
  const std::vector<glm::dvec3> positions = worldPositions(load(asset));
  EXPECT_EQ(positions[1], glm::dvec3(1, 0, 0));
  EXPECT_EQ(positions[2], glm::dvec3(0, 1, 0));
}

TEST(GltfPose, JointsFarFromTheOriginKeepTheirPrecision) {
  GltfAsset asset = skinnedAsset();
  asset.json["nodes"][1]["translation"] = {1e8, 0, 0};
  const std::vector<glm::dvec3> positions = worldPositions(load(asset));
  EXPECT_EQ(positions[1] - positions[0], glm::dvec3(1, 10, 0));
}

TEST(GltfPose, AJointOutsideOfTheSkinIsRefused) {
  GltfAsset asset = skinnedAsset();
  asset.json["skins"][0]["joints"] = {1};
  EXPECT_THROW((void)load(asset), SceneError);
}

TEST(GltfPose, VerticesWithoutWeightsStayWithTheFirstJoint) {
  GltfAsset asset = skinnedAsset();
  asset.attribute("WEIGHTS_0") = asset.addFloats({1, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
  const Scene scene = load(asset);
  EXPECT_EQ(worldPositions(scene)[1], glm::dvec3(1, 0, 0));
  EXPECT_TRUE(warns(scene, "without joint weights"));
}

TEST(GltfPose, AnimationsAreIgnoredWithOneWarning) {
  GltfAsset asset = triangleAsset();
  asset.json["animations"] = {Json::object(), Json::object()};
  const Scene scene = load(asset);
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_TRUE(warns(scene, "animations are ignored"));
}
