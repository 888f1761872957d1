// Numbers, ranges and indices that do not hold: bad inputs 8 to 18.
#include <limits>

#include <gtest/gtest.h>

#include "robustness/refusal.hpp"
#include "unit/gltf_png.hpp"

using namespace isophote;
using namespace isophote::test;

namespace {

/// The triangle with `changes` merged into accessor 0.
GltfAsset withAccessor(const Json& changes) {
  GltfAsset asset = triangleAsset();
  asset.json["accessors"][0].update(changes);
  return asset;
}

GltfAsset withView(const Json& changes) {
  GltfAsset asset = triangleAsset();
  asset.json["bufferViews"][0].update(changes);
  return asset;
}

GltfAsset withNodes(const Json& nodes, const Json& roots = {0}) {
  GltfAsset asset = triangleAsset();
  asset.json["nodes"] = nodes;
  asset.json["scenes"] = {{{"nodes", roots}}};
  return asset;
}

/// Sparse accessor over three positions with 8-bit sparse indices.
GltfAsset withSparse(const std::vector<uint8_t>& indices, const Json& changes = Json::object()) {
  GltfAsset asset = triangleAsset();
  const std::string values(12 * indices.size(), '\1');
  asset.json["accessors"][0]["sparse"] = {
      {"count", indices.size()},
      {"indices",
       {{"bufferView", asset.addView(std::string(indices.begin(), indices.end()))}, {"componentType", kUInt8}}},
      {"values", {{"bufferView", asset.addView(values)}}}};
  asset.json["accessors"][0]["sparse"].update(changes, true);
  return asset;
}

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

} // namespace

TEST(BadInput08, BuffersShorterThanTheirLengthAreRefused) {
  GltfAsset asset = triangleAsset();
  asset.json["buffers"] = {{{"byteLength", 37}, {"uri", "data:;base64," + base64(asset.data)}}};
  expectRefused<SceneError>(asset, {"/buffers/0/byteLength: ", "BUFFER_BYTE_LENGTH_MISMATCH"});
  asset.json["buffers"][0]["byteLength"] = 0;
  expectRefused<SceneError>(asset, {"/buffers/0/byteLength: "});
  const TemporaryFolder folder;
  folder.write("short.bin", asset.data.substr(1));
  asset.json["buffers"] = {{{"byteLength", 36}, {"uri", "short.bin"}}};
  EXPECT_NE(refusalOf<SceneError>(folder, asset.gltf()).find("/buffers/0/byteLength: "), std::string::npos);
}

TEST(BadInput09, BufferViewPastBufferIsRefused) {
  for (const Json& view :
       {Json{{"byteLength", 37}}, Json{{"byteOffset", 1}}, Json{{"byteOffset", 36}}, Json{{"byteOffset", 1000}},
        Json{{"byteOffset", UINT64_MAX}}, Json{{"byteOffset", UINT64_MAX - 35}}, Json{{"byteLength", UINT64_MAX}}}) {
    expectRefused<SceneError>(withView(view), {"/bufferViews/0: ", "BUFFER_VIEW_TOO_LONG"});
  }
  expectRefused<SceneError>(withView({{"byteOffset", -4}}), {"/bufferViews/0/byteOffset: "});
}

TEST(BadInput09, AccessorPastBufferIsRefused) {
  for (const Json& accessor : {Json{{"count", 4}}, Json{{"byteOffset", 4}}, Json{{"byteOffset", UINT64_MAX - 3}},
                               Json{{"byteOffset", 1u << 30}}, Json{{"type", "VEC4"}}, Json{{"type", "MAT4"}}}) {
    expectRefused<SceneError>(withAccessor(accessor), {"/accessors/0: ", "ACCESSOR_TOO_LONG"});
  }
  GltfAsset strided = withView({{"byteStride", 16}});
  expectRefused<SceneError>(strided, {"/accessors/0: ", "ACCESSOR_TOO_LONG"});
}

TEST(BadInput10, ImpossibleCountsAreRefused) {
  for (const Json& count : {Json(1u << 31), Json(1ull << 53), Json(UINT64_MAX), Json(UINT64_MAX / 12 + 2)}) {
    expectRefused<SceneError>(withAccessor({{"count", count}}), {"/accessors/0: ", "ACCESSOR_TOO_LONG"});
  }
  for (const Json& count : {Json(0), Json(-1), Json(3.0), Json("3"), Json(nullptr), Json(1e20)}) {
    expectRefused<SceneError>(withAccessor({{"count", count}}), {"/accessors/0/count: "});
  }
}

TEST(BadInput10, UnknownTypesAreRefused) {
  expectRefused<SceneError>(withAccessor({{"componentType", 5124}}), {"/accessors/0/componentType: "});
  expectRefused<SceneError>(withAccessor({{"componentType", 0}}), {"/accessors/0/componentType: "});
  expectRefused<SceneError>(withAccessor({{"type", "VEC5"}}), {"/accessors/0/type: "});
  expectRefused<SceneError>(withAccessor({{"type", ""}}), {"/accessors/0/type: "});
}

TEST(BadInput10, StridesAndAlignmentsThatDoNotFitAreRefused) {
  expectRefused<SceneError>(withView({{"byteStride", 8}}), {"/bufferViews/0/byteStride: "});
  expectRefused<SceneError>(withView({{"byteStride", 3}}), {"/bufferViews/0/byteStride: "});
  expectRefused<SceneError>(withView({{"byteStride", 256}}), {"/bufferViews/0/byteStride: "});
  expectRefused<SceneError>(withView({{"byteStride", 14}}), {"/bufferViews/0/byteStride: "});
  GltfAsset asset = withAccessor({{"byteOffset", 2}, {"count", 1}});
  expectRefused<SceneError>(asset, {"/accessors/0/byteOffset: ", "ACCESSOR_OFFSET_ALIGNMENT"});
  asset = withAccessor({{"count", 2}});
  asset.json["bufferViews"][0].update(Json{{"byteOffset", 2}, {"byteLength", 30}});
  expectRefused<SceneError>(asset, {"/accessors/0/byteOffset: ", "ACCESSOR_OFFSET_ALIGNMENT"});
}

TEST(BadInput10, AttributesOfTheWrongTypeAreRefused) {
  expectRefused<SceneError>(withAccessor({{"type", "VEC2"}}),
                            {"/meshes/0/primitives/0/attributes/POSITION: ", "INVALID_FORMAT"});
  GltfAsset asset = triangleAsset();
  asset.attribute("NORMAL") = asset.addAccessor<uint8_t>(std::vector<uint8_t>(9), kUInt8, "VEC3");
  expectRefused<SceneError>(asset, {"/meshes/0/primitives/0/attributes/NORMAL: ", "INVALID_FORMAT"});
  asset = triangleAsset();
  asset.attribute("COLOR_0") = asset.addFloats(std::vector<float>(6), "VEC2");
  expectRefused<SceneError>(asset, {"/meshes/0/primitives/0/attributes/COLOR_0: "});
  asset = triangleAsset();
  asset.attribute("TEXCOORD_0") = asset.addFloats(std::vector<float>(4), "VEC2");
  expectRefused<SceneError>(asset, {"/meshes/0/primitives/0/attributes/TEXCOORD_0: ", "UNEQUAL_ACCESSOR_COUNT"});
  asset = triangleAsset();
  asset.primitive()["indices"] = asset.addFloats({0, 1, 2}, "SCALAR");
  expectRefused<SceneError>(asset, {"/meshes/0/primitives/0/indices: "});
}

TEST(BadInput11, IndicesBeyondTheVerticesAreRefused) {
  GltfAsset asset = triangleAsset();
  asset.primitive()["indices"] = asset.addIndices({0, 1, 3});
  expectRefused<SceneError>(asset, {"/accessors/1: ", "found 3 at place 2", "ACCESSOR_INDEX_OOB"});
  asset = triangleAsset();
  asset.primitive()["indices"] = asset.addIndices({0, 1, 0xffff});
  expectRefused<SceneError>(asset, {"/accessors/1: ", "ACCESSOR_INDEX_PRIMITIVE_RESTART"});
  asset = triangleAsset();
  asset.primitive()["indices"] = asset.addAccessor<uint32_t>({0, 1, 0x80000000}, kUInt32, "SCALAR");
  expectRefused<SceneError>(asset, {"/accessors/1: "});
}

TEST(BadInput11, ATailOfIndicesIsDroppedWithAWarning) {
  GltfAsset asset = triangleAsset();
  asset.primitive()["indices"] = asset.addIndices({0, 1, 2, 0});
  EXPECT_TRUE(warns(load(asset), "after the last whole triangle"));
}

TEST(BadInput12, SparseIndicesHaveToIncreaseBelowTheCount) {
  EXPECT_EQ(load(withSparse({0, 2})).instances.size(), 0u) << "valid: only makes the triangle degenerate";
  expectRefused<SceneError>(withSparse({0, 3}), {"/accessors/0/sparse/indices: ", "ACCESSOR_SPARSE_INDEX_OOB"});
  expectRefused<SceneError>(withSparse({2, 1}), {"/accessors/0/sparse/indices: "});
  expectRefused<SceneError>(withSparse({1, 1}), {"/accessors/0/sparse/indices: "});
  expectRefused<SceneError>(withSparse({0}, {{"count", 4}}), {"/accessors/0/sparse/count: "});
  expectRefused<SceneError>(withSparse({0}, {{"count", 2}}), {"/accessors/0/sparse/indices: ", "ACCESSOR_TOO_LONG"});
  expectRefused<SceneError>(withSparse({0}, {{"values", {{"byteOffset", UINT64_MAX - 3}}}}),
                            {"/accessors/0/sparse/values: ", "ACCESSOR_TOO_LONG"});
  expectRefused<SceneError>(withSparse({0}, {{"values", {{"byteOffset", 2}}}}),
                            {"/accessors/0/sparse/values/byteOffset: "});
}

TEST(BadInput13, PositionsThatAreNotFiniteAreRefused) {
  for (const float bad : {kNan, kInfinity, -kInfinity}) {
    GltfAsset asset = triangleAsset();
    asset.attribute("POSITION") = asset.addFloats({0, 0, 0, 1, bad, 0, 0, 1, 0}, "VEC3");
    expectRefused<SceneError>(asset, {"/accessors/1: ", "element 1", "ACCESSOR_INVALID_FLOAT"});
  }
}

TEST(BadInput13, MorphTargetsThatOverflowAreRefused) {
  GltfAsset asset = triangleAsset();
  asset.primitive()["targets"] = {{{"POSITION", asset.addFloats(std::vector<float>(9, 3e38f), "VEC3")}}};
  asset.json["meshes"][0]["weights"] = {1e10};
  expectRefused<SceneError>(asset, {"/meshes/0/primitives/0: ", "finite positions after"});
}

TEST(BadInput14, BadNormalsAndTangentsAreRecomputedWithOneWarningEach) {
  GltfAsset asset = texturedTriangleAsset();
  asset.attribute("NORMAL") = asset.addFloats({kNan, 0, 0, 0, 0, 0, 0, 0, 1}, "VEC3");
  asset.attribute("TANGENT") = asset.addFloats({1, 0, 0, 2, 0, 0, 0, 1, kNan, 0, 0, 1}, "VEC4");
  const Scene scene = load(asset);
  EXPECT_EQ(scene.meshes[0].primitives[0].normals, std::vector<glm::vec3>(3, glm::vec3(0, 0, 1)));
  EXPECT_EQ(scene.warnings.size(), 2u);
  EXPECT_TRUE(warns(scene, "recomputed (2 times"));
  EXPECT_TRUE(warns(scene, "recomputed (3 times"));
}

TEST(BadInput15, DegenerateAndDuplicateTrianglesAreDroppedAndCounted) {
  GltfAsset asset = triangleAsset();
  asset.primitive()["indices"] = asset.addIndices({0, 1, 2, 0, 1, 1, 1, 2, 0, 2, 2, 2});
  const Scene scene = load(asset);
  EXPECT_EQ(scene.meshes[0].primitives[0].indices.size(), 3u);
  EXPECT_TRUE(warns(scene, "triangles without area are dropped (2 times"));
  EXPECT_TRUE(warns(scene, "triangles that stand there twice are dropped"));
}

TEST(BadInput16, NodeLoopsAreRefused) {
  expectRefused<SceneError>(withNodes({{{"children", {0}}}}), {"/nodes/0: ", "NODE_LOOP"});
  expectRefused<SceneError>(withNodes({Json::object(), {{"children", {2}}}, {{"children", {1}}}}),
                            {"/nodes/", "NODE_LOOP"});
}

TEST(BadInput16, NodesWithTwoParentsAreRefused) {
  expectRefused<SceneError>(withNodes({{{"children", {2}}}, {{"children", {2}}}, {{"mesh", 0}}}, {0, 1}),
                            {"/nodes/1/children/0: ", "NODE_PARENT_OVERRIDE"});
  expectRefused<SceneError>(withNodes({{{"children", {1, 1}}}, {{"mesh", 0}}}), {"/nodes/0/children/1: "});
  expectRefused<SceneError>(withNodes({{{"children", {1}}}, {{"mesh", 0}}}, {0, 1}),
                            {"/scenes/0/nodes/1: ", "SCENE_NON_ROOT_NODE"});
  expectRefused<SceneError>(withNodes({{{"mesh", 0}}}, {0, 0}), {"/scenes/0/nodes/1: "});
}

TEST(BadInput16, SceneIndicesOutOfRangeAreRefused) {
  GltfAsset asset = triangleAsset();
  asset.json["scene"] = 1;
  expectRefused<SceneError>(asset, {"/scene: ", "UNRESOLVED_REFERENCE"});
  expectRefused<SceneError>(triangleAsset(), {"/scenes: "}, {.scene = 1});
}

TEST(BadInput17, MatricesThatAreNotNumbersOrNotAffineAreRefused) {
  expectRefused<SceneError>(withNodes({{{"mesh", 0}, {"matrix", {1, 0, 0}}}}), {"/nodes/0/matrix: "});
  expectRefused<SceneError>(withNodes({{{"mesh", 0}, {"translation", {0, nullptr, 0}}}}), {"/nodes/0/translation/1: "});
  expectRefused<SceneError>(withNodes({{{"mesh", 0}, {"matrix", {1, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}}}),
                            {"/nodes/0/matrix: ", "affine"});
  expectRefused<SceneError>(
      withNodes({{{"children", {1}}, {"scale", {1e300, 1, 1}}}, {{"mesh", 0}, {"scale", {1e300, 1, 1}}}}),
      {"/nodes/1: ", "finite"});
  std::string text = withNodes({{{"mesh", 0}, {"translation", {0, 123456, 0}}}}).gltf();
  text.replace(text.find("123456"), 6, "NaN");
  expectRefused<SceneError>(text, {"valid JSON"});
}

TEST(BadInput17, SingularTransformsAreSkippedAndMirroredOnesKept) {
  const Scene scene = load(withNodes({{{"mesh", 0}, {"scale", {0, 0, 0}}},
                                      {{"mesh", 0}, {"scale", {1e-40, 1, 1}}},
                                      {{"mesh", 0}, {"scale", {1, 1, -1}}}},
                                     {0, 1, 2}));
  EXPECT_EQ(scene.instances.size(), 1u);
  EXPECT_TRUE(warns(scene, "singular transform is skipped (2 times"));
}

TEST(BadInput18, IndicesOutOfRangeAreRefusedEverywhere) {
  GltfAsset valid = texturedTriangleAsset();
  valid.material()["emissiveTexture"] = {{"index", 0}};
  valid.add("textures", {{"source", valid.addImage(pngPixel(0, 0, 0, 0))}, {"sampler", 0}});
  valid.add("samplers", Json::object());
  valid.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}});
  valid.json["nodes"][0]["camera"] = 0;
  valid.json["nodes"][0]["skin"] = 0;
  valid.json["nodes"][0]["children"] = {1};
  valid.add("nodes", {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  valid.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
  valid.add("skins", {{"joints", {1}}});
  EXPECT_EQ(load(valid).instances.size(), 1u);
  for (const std::string pointer :
       {"/meshes/0/primitives/0/material", "/materials/0/emissiveTexture/index", "/textures/0/source",
        "/textures/0/sampler", "/images/0/bufferView", "/nodes/0/camera", "/nodes/0/skin", "/nodes/0/mesh",
        "/nodes/0/children/0", "/nodes/1/extensions/KHR_lights_punctual/light", "/skins/0/joints/0",
        "/meshes/0/primitives/0/attributes/POSITION", "/accessors/0/bufferView", "/bufferViews/0/buffer",
        "/scenes/0/nodes/0"}) {
    for (const Json& bad :
         {Json(-1), Json(1000), Json(1ull << 32), Json(UINT64_MAX), Json(0.0), Json("0"), Json(nullptr)}) {
      GltfAsset broken = valid;
      broken.json[Json::json_pointer(pointer)] = bad;
      expectRefused<SceneError>(broken, {pointer + ": ", "UNRESOLVED_REFERENCE"});
    }
  }
}
