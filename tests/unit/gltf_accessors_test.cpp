// Every form in which glTF stores numbers.
#include <cmath>

#include <gtest/gtest.h>

#include "isophote/error.hpp"
#include "unit/gltf_asset.hpp"

using namespace isophote;
using namespace isophote::test;

namespace {

const Primitive& onlyPrimitive(const Scene& scene) {
  EXPECT_EQ(scene.meshes.size(), 1u);
  return scene.meshes.at(0).primitives.at(0);
}

} // namespace

TEST(GltfAccessors, PlainFloatPositionsAreReadAsTheyStand) {
  const Scene scene = load(triangleAsset());
  const Primitive& primitive = onlyPrimitive(scene);
  ASSERT_EQ(primitive.positions.size(), 3u);
  EXPECT_EQ(primitive.positions[1], glm::vec3(1, 0, 0));
  EXPECT_EQ(primitive.positions[2], glm::vec3(0, 1, 0));
  EXPECT_EQ(primitive.indices, (std::vector<uint32_t>{0, 1, 2}));
  EXPECT_TRUE(primitive.normals.empty());
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(GltfAccessors, GlbHoldsTheSameAsGltf) {
  const GltfAsset asset = triangleAsset();
  EXPECT_EQ(onlyPrimitive(load(asset.glb())).positions, onlyPrimitive(load(asset.gltf())).positions);
}

TEST(GltfAccessors, InterleavedViewsAreReadWithTheirStride) {
  GltfAsset asset = triangleAsset();
  // position (12 bytes), normal (12), 4 bytes of padding
  const std::vector<float> rows = {0, 0, 0, 0, 0, 1, 9, 2, 0, 0, 0, 0, 1, 9, 0, 2, 0, 0, 0, 1, 9};
  const size_t positions = asset.addFloats(rows, "SCALAR");
  const size_t view = asset.json["accessors"][positions]["bufferView"];
  asset.json["bufferViews"][view]["byteStride"] = 28;
  asset.json["accessors"][positions] = {
      {"bufferView", view}, {"componentType", kFloat32}, {"count", 3}, {"type", "VEC3"}};
  asset.attribute("POSITION") = positions;
  asset.attribute("NORMAL") = asset.add(
      "accessors",
      {{"bufferView", view}, {"byteOffset", 12}, {"componentType", kFloat32}, {"count", 3}, {"type", "VEC3"}});
  const Scene scene = load(asset);
  EXPECT_EQ(onlyPrimitive(scene).positions[1], glm::vec3(2, 0, 0));
  EXPECT_EQ(onlyPrimitive(scene).positions[2], glm::vec3(0, 2, 0));
  EXPECT_EQ(onlyPrimitive(scene).normals, std::vector<glm::vec3>(3, glm::vec3(0, 0, 1)));
}

TEST(GltfAccessors, QuantizedPositionsOfEveryTypeAreConverted) {
  struct Case {
    int type;
    bool normalized;
    glm::vec3 second;
  };
  // Stored as (0,0,0) (100,0,0) (0,100,0), in rows padded to 4 bytes; KHR_mesh_quantization's conversions.
  for (const Case& c : {Case{kInt8, false, {100, 0, 0}}, Case{kInt8, true, {100.0f / 127, 0, 0}},
                        Case{kUInt8, false, {100, 0, 0}}, Case{kUInt8, true, {100.0f / 255, 0, 0}},
                        Case{kInt16, false, {100, 0, 0}}, Case{kInt16, true, {100.0f / 32767, 0, 0}},
                        Case{kUInt16, false, {100, 0, 0}}, Case{kUInt16, true, {100.0f / 65535, 0, 0}}}) {
    GltfAsset asset = triangleAsset();
    asset.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    const bool isByte = c.type == kInt8 || c.type == kUInt8;
    const size_t accessor =
        isByte ? asset.addAccessor<int8_t>({0, 0, 0, 0, 100, 0, 0, 0, 0, 100, 0, 0}, c.type, "VEC3", c.normalized)
               : asset.addAccessor<int16_t>({0, 0, 0, 0, 100, 0, 0, 0, 0, 100, 0, 0}, c.type, "VEC3", c.normalized);
    asset.json["accessors"][accessor]["count"] = 3;
    asset.json["bufferViews"][asset.json["accessors"][accessor]["bufferView"].get<size_t>()]["byteStride"] =
        isByte ? 4 : 8;
    asset.attribute("POSITION") = accessor;
    EXPECT_EQ(onlyPrimitive(load(asset)).positions[1], c.second) << c.type << c.normalized;
  }
}

TEST(GltfAccessors, TheMostNegativeNormalizedIntegerIsMinusOne) {
  GltfAsset asset = triangleAsset();
  asset.attribute("POSITION") = asset.addAccessor<int16_t>({0, 0, 0, -32768, 0, 0, 0, 32767, 0}, kInt16, "VEC3", true);
  const Scene scene = load(asset);
  EXPECT_EQ(onlyPrimitive(scene).positions[1], glm::vec3(-1, 0, 0));
  EXPECT_EQ(onlyPrimitive(scene).positions[2], glm::vec3(0, 1, 0));
}

TEST(GltfAccessors, SparseValuesReplaceDenseOnes) {
  GltfAsset asset = triangleAsset();
  const std::string index{"\x02\0", 2};
  const float value[3] = {0, 5, 0};
  Json& accessor = asset.json["accessors"][0];
  accessor["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", asset.addView(index)}, {"componentType", kUInt16}}},
      {"values", {{"bufferView", asset.addView({reinterpret_cast<const char*>(value), sizeof(value)})}}}};
  const Scene scene = load(asset);
  EXPECT_EQ(onlyPrimitive(scene).positions[1], glm::vec3(1, 0, 0));
  EXPECT_EQ(onlyPrimitive(scene).positions[2], glm::vec3(0, 5, 0));
}

TEST(GltfAccessors, WithoutBufferViewTheRestOfASparseAccessorIsZero) {
  GltfAsset asset = triangleAsset();
  const std::string indices{"\x01\x02", 2};
  const float values[6] = {3, 0, 0, 0, 4, 0};
  asset.json["accessors"][0].erase("bufferView");
  asset.json["accessors"][0]["sparse"] = {
      {"count", 2},
      {"indices", {{"bufferView", asset.addView(indices)}, {"componentType", kUInt8}}},
      {"values", {{"bufferView", asset.addView({reinterpret_cast<const char*>(values), sizeof(values)})}}}};
  const Scene scene = load(asset);
  EXPECT_EQ(onlyPrimitive(scene).positions, (std::vector<glm::vec3>{{0, 0, 0}, {3, 0, 0}, {0, 4, 0}}));
}

TEST(GltfAccessors, IndicesMayBeSparseWithoutBufferView) {
  GltfAsset asset = triangleAsset();
  const std::string places{"\x01\x02", 2};
  const std::string values{"\x02\0\x01\0", 4};
  asset.primitive()["indices"] =
      asset.add("accessors", {{"componentType", kUInt16},
                              {"count", 3},
                              {"type", "SCALAR"},
                              {"sparse",
                               {{"count", 2},
                                {"indices", {{"bufferView", asset.addView(places)}, {"componentType", kUInt8}}},
                                {"values", {{"bufferView", asset.addView(values)}}}}}});
  EXPECT_EQ(onlyPrimitive(load(asset)).indices, (std::vector<uint32_t>{0, 2, 1}));
}

TEST(GltfAccessors, IndicesOfEveryUnsignedTypeAreRead) {
  for (const int type : {kUInt8, kUInt16, kUInt32}) {
    GltfAsset asset = triangleAsset();
    asset.primitive()["indices"] = type == kUInt8    ? asset.addAccessor<uint8_t>({2, 0, 1}, type, "SCALAR")
                                   : type == kUInt16 ? asset.addAccessor<uint16_t>({2, 0, 1}, type, "SCALAR")
                                                     : asset.addAccessor<uint32_t>({2, 0, 1}, type, "SCALAR");
    EXPECT_EQ(onlyPrimitive(load(asset)).indices, (std::vector<uint32_t>{2, 0, 1})) << type;
  }
}

TEST(GltfAccessors, NormalizedTextureCoordinatesAndColorsAreConverted) {
  GltfAsset asset = triangleAsset();
  asset.attribute("TEXCOORD_1") = asset.addAccessor<uint16_t>({0, 0, 65535, 0, 0, 32768}, kUInt16, "VEC2", true);
  asset.attribute("COLOR_0") =
      asset.addAccessor<uint8_t>({255, 0, 51, 0, 0, 0, 0, 255, 0, 102, 0, 255}, kUInt8, "VEC4", true);
  const Scene scene = load(asset);
  const Primitive& primitive = onlyPrimitive(scene);
  EXPECT_TRUE(primitive.uvs[0].empty());
  EXPECT_EQ(primitive.uvs[1][1], glm::vec2(1, 0));
  EXPECT_EQ(primitive.uvs[1][2], glm::vec2(0, 32768.0f / 65535));
  EXPECT_EQ(primitive.colors[0], glm::vec4(1, 0, 51.0f / 255, 0));
}

TEST(GltfAccessors, ColorsWithoutAlphaAreOpaque) {
  GltfAsset asset = triangleAsset();
  asset.attribute("COLOR_0") = asset.addFloats({0.25f, 0.5f, 0.75f, 1, 1, 1, 0, 0, 0}, "VEC3");
  const Scene scene = load(asset);
  EXPECT_EQ(onlyPrimitive(scene).colors[0], glm::vec4(0.25f, 0.5f, 0.75f, 1));
}

TEST(GltfAccessors, AllFourUvSetsAreKept) {
  GltfAsset asset = triangleAsset();
  for (int set = 0; set < 5; ++set) {
    asset.attribute("TEXCOORD_" + std::to_string(set)) =
        asset.addFloats(std::vector<float>(6, static_cast<float>(set)), "VEC2");
  }
  const Scene scene = load(asset);
  for (size_t set = 0; set < kMaxUvSets; ++set) {
    EXPECT_EQ(onlyPrimitive(scene).uvs[set].at(0), glm::vec2(static_cast<float>(set)));
  }
  EXPECT_TRUE(warns(scene, "UV sets above 3"));
}

TEST(GltfAccessors, TheDecodedSizeIsLimitedBeforeAnythingIsAllocated) {
  GltfAsset asset = triangleAsset();
  // No buffer view: a few bytes of JSON ask for 48 GB of zeros.
  asset.json["accessors"][0] = {{"componentType", kFloat32}, {"count", 4'000'000'000u}, {"type", "VEC3"}};
  EXPECT_THROW((void)load(asset), LimitError);
}
