// KHR_draco_mesh_compression, EXT_meshopt_compression, KHR_meshopt_compression and EXT_texture_webp give back what was
// packed, and are refused where a stream is broken.
#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "isophote/error.hpp"
#include "robustness/refusal.hpp"
#include "scene/draco_decode.hpp"
#include "scene/meshopt_decode.hpp"
#include "scene/webp_decode.hpp"
#include "unit/gltf_compressed.hpp"

using namespace isophote;
using namespace isophote::test;

namespace {

#define SKIP_UNLESS(available)                                                                                         \
  if (!(available)) GTEST_SKIP() << "this build lacks the library"

/// Triangles by the places of their corners on a grid of n x n cells, each from its smallest corner on, sorted: the
/// same whatever the order of vertices and triangles.
std::vector<std::array<int, 3>> triangles(const std::vector<glm::vec3>& positions, const std::vector<uint32_t>& indices,
                                          uint32_t n) {
  const auto place = [&](uint32_t index) {
    const glm::vec3 p = positions[index] * static_cast<float>(n);
    return static_cast<int>(std::lround(p.y)) * static_cast<int>(n + 1) + static_cast<int>(std::lround(p.x));
  };
  std::vector<std::array<int, 3>> result;
  for (size_t i = 0; i + 3 <= indices.size(); i += 3) {
    std::array<int, 3> corners = {place(indices[i]), place(indices[i + 1]), place(indices[i + 2])};
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    result.push_back(corners);
  }
  std::sort(result.begin(), result.end());
  return result;
}

/// The sheet within `tolerance`, whatever the order of its vertices; normals, where it has them, to 1 / 2^7 twice.
void expectSheet(const Primitive& primitive, uint32_t n, float tolerance) {
  const CompressibleMesh sheet = bentSheet(n);
  ASSERT_EQ(primitive.positions.size(), sheet.positions.size());
  EXPECT_EQ(triangles(primitive.positions, primitive.indices, n), triangles(sheet.positions, sheet.indices, n));
  for (size_t i = 0; i < primitive.positions.size(); ++i) {
    const glm::vec3 p = primitive.positions[i];
    const float x = std::round(p.x * static_cast<float>(n)) / static_cast<float>(n);
    const float y = std::round(p.y * static_cast<float>(n)) / static_cast<float>(n);
    EXPECT_NEAR(p.x, x, tolerance);
    EXPECT_NEAR(p.y, y, tolerance);
    EXPECT_NEAR(p.z, x * x / 4, tolerance);
    if (!primitive.normals.empty()) {
      EXPECT_GT(glm::dot(primitive.normals[i], glm::normalize(glm::vec3(-x / 2, 0, 1))), 1 - 2.f / (128 * 128));
    }
    if (!primitive.uvs[0].empty()) {
      EXPECT_NEAR(primitive.uvs[0][i].x, x, 1.f / 4096);
      EXPECT_NEAR(primitive.uvs[0][i].y, y, 1.f / 4096);
    }
  }
}

} // namespace

TEST(GltfCompressed, DracoGivesBackTheMesh) {
  SKIP_UNLESS(dracoAvailable());
  for (const DracoMethod method : {DracoMethod::Sequential, DracoMethod::Edgebreaker}) {
    const Scene scene = load(dracoAsset(method));
    ASSERT_EQ(scene.meshes.size(), 1u);
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0];
    expectSheet(scene.meshes[0].primitives[0], 4, 1.f / (1 << 14));
    EXPECT_FALSE(scene.meshes[0].primitives[0].normals.empty());
    EXPECT_FALSE(scene.meshes[0].primitives[0].uvs[0].empty());
  }
}

// Two primitives may describe their data by the same accessors and still have a stream each.
TEST(GltfCompressed, DracoStreamsMayShareAccessors) {
  SKIP_UNLESS(dracoAvailable());
  GltfAsset asset = dracoAsset(DracoMethod::Sequential);
  CompressibleMesh moved = bentSheet(4);
  for (glm::vec3& p : moved.positions) p.x += 10;
  Json second = asset.primitive();
  second["extensions"]["KHR_draco_mesh_compression"]["bufferView"] =
      asset.addView(encodeDraco(moved, DracoMethod::Sequential).bytes);
  asset.json["meshes"][0]["primitives"].push_back(second);
  const Bounds bounds = worldBounds(load(asset));
  EXPECT_NEAR(bounds.lower.x, 0, 1e-3);
  EXPECT_NEAR(bounds.upper.x, 11, 1e-3);
}

TEST(GltfCompressed, MeshoptGivesBackEveryModeAndFilter) {
  SKIP_UNLESS(meshoptAvailable());
  for (const char* extension : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
    const Scene scene = load(meshoptAsset(extension).glb());
    ASSERT_EQ(scene.meshes.size(), 2u);
    EXPECT_TRUE(scene.extensionsIgnored.empty());
    const Primitive& exact = scene.meshes[0].primitives[0];
    expectSheet(exact, 4, 0);
    EXPECT_FALSE(exact.normals.empty());
    expectSheet(scene.meshes[1].primitives[0], 4, 1.f / (1 << 14));
    ASSERT_EQ(scene.instances.size(), 3u);
    // The quarter turn about z takes x to y.
    const glm::dvec3 turned(scene.instances[2].worldFromObject * glm::dvec4(1, 0, 0, 0));
    EXPECT_NEAR(turned.x, 0, 1e-4);
    EXPECT_NEAR(turned.y, 1, 1e-4);
  }
}

TEST(GltfCompressed, WebpGivesBackThePixels) {
  SKIP_UNLESS(webpAvailable());
  const Scene scene = load(webpAsset());
  ASSERT_EQ(scene.images.size(), 1u);
  const ImageData& image = scene.images[0];
  EXPECT_EQ(image.width, 2u);
  EXPECT_EQ(image.height, 2u);
  EXPECT_EQ(bytesOf(image.pixels), kFourPixels);
}

TEST(GltfCompressed, DracoThatContradictsItsAccessorsIsRefused) {
  SKIP_UNLESS(dracoAvailable());
  const auto refused = [](const char* what, const auto& change, const char* text) {
    SCOPED_TRACE(what);
    GltfAsset asset = dracoAsset(DracoMethod::Edgebreaker);
    change(asset);
    expectRefused<SceneError>(asset, {"/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression", text});
  };
  const auto draco = [](GltfAsset& asset) -> Json& {
    return asset.primitive()["extensions"]["KHR_draco_mesh_compression"];
  };
  refused(
      "more indices", [](GltfAsset& a) { a.json["accessors"][3]["count"] = 99; }, "99 indices");
  refused(
      "fewer vertices", [](GltfAsset& a) { a.json["accessors"][0]["count"] = 24; }, "24 vertices");
  refused(
      "more vertices", [](GltfAsset& a) { a.json["accessors"][0]["count"] = 26; }, "26 elements");
  refused(
      "components", [](GltfAsset& a) { a.json["accessors"][1]["type"] = "VEC4"; }, "/attributes/NORMAL");
  refused(
      "unknown id", [&](GltfAsset& a) { draco(a)["attributes"]["NORMAL"] = 77; }, "found 77");
  refused(
      "unknown name", [&](GltfAsset& a) { draco(a)["attributes"]["TANGENT"] = 1; }, "/attributes/TANGENT");
  refused(
      "cut", [](GltfAsset& a) { a.json["bufferViews"][0]["byteLength"] = 60; }, "a whole Draco stream");
  refused(
      "cut early", [](GltfAsset& a) { a.json["bufferViews"][0]["byteLength"] = 11; }, "a Draco stream");
  refused(
      "no Draco", [](GltfAsset& a) { a.data[0] = 'd'; }, "a Draco stream");
}

// The stream announces 2^32 - 1 triangles; so does the accessor. Nothing of that size is allocated.
TEST(GltfCompressed, DracoOfHugeCountsIsOverTheLimit) {
  SKIP_UNLESS(dracoAvailable());
  GltfAsset asset = dracoAsset(DracoMethod::Sequential);
  constexpr size_t kFacesOffset = 11; // after the header of 11 bytes: a number of 7 bits a byte, 32 triangles
  ASSERT_EQ(asset.data[kFacesOffset], 32);
  asset.data.replace(kFacesOffset, 1, "\xff\xff\xff\xff\x0f");
  asset.json["bufferViews"][0]["byteLength"] = asset.data.size();
  expectRefused<SceneError>(asset, {"found 4294967295 triangles"});
  asset.json["accessors"][3]["count"] = 3 * 4294967295ull;
  expectRefused<LimitError>(asset, {"KHR_draco_mesh_compression"});
}

TEST(GltfCompressed, BrokenMeshoptIsRefusedWithItsPointer) {
  SKIP_UNLESS(meshoptAvailable());
  const auto refused = [](const char* what, size_t packedView, const auto& change, const char* text) {
    SCOPED_TRACE(what);
    GltfAsset asset = meshoptAsset();
    const size_t view = 2 * packedView + 1; // each follows the view that holds its stream
    change(asset, asset.json["bufferViews"][view],
           asset.json["bufferViews"][view]["extensions"]["EXT_meshopt_compression"]);
    const std::string pointer = "/bufferViews/" + std::to_string(view) + "/extensions/EXT_meshopt_compression";
    expectRefused<SceneError>(asset.glb(), {pointer, text});
  };
  refused(
      "mode", 0, [](auto&, Json&, Json& p) { p["mode"] = "POINTS"; }, "/mode");
  refused(
      "filter", 0, [](auto&, Json&, Json& p) { p["filter"] = "BLUR"; }, "/filter");
  refused(
      "filter of indices", 4, [](auto&, Json&, Json& p) { p["filter"] = "OCTAHEDRAL"; }, "/filter");
  refused(
      "stride", 0, [](auto&, Json& v, Json& p) { v["byteStride"] = p["byteStride"] = 10; }, "/byteStride");
  refused(
      "two strides", 0, [](auto&, Json& v, Json&) { v["byteStride"] = 16; }, "/byteStride");
  refused(
      "stride of octahedral", 2, [](auto&, Json& v, Json& p) { v["byteStride"] = p["byteStride"] = 12; }, "Stride");
  refused(
      "index stride", 4, [](auto&, Json&, Json& p) { p["byteStride"] = 1; }, "/byteStride");
  refused(
      "triangles", 4, [](auto&, Json&, Json& p) { p["count"] = 95; }, "/count");
  refused(
      "more than the view", 0, [](auto&, Json&, Json& p) { p["count"] = 26; }, "/count");
  refused(
      "cut", 0, [](auto&, Json&, Json& p) { p["byteLength"] = 40; }, "a whole meshopt stream");
  refused(
      "too long", 0, [](auto&, Json&, Json& p) { p["byteLength"] = 1 << 20; }, "BUFFER_VIEW_TOO_LONG");
  refused(
      "no vertices", 0, [](GltfAsset& a, Json&, Json& p) { a.data[p["byteOffset"].get<size_t>()] = 0; }, "stream");
  refused(
      "no indices", 4, [](GltfAsset& a, Json&, Json& p) { a.data[p["byteOffset"].get<size_t>()] = 0; }, "stream");
}

TEST(GltfCompressed, MeshoptOfHugeCountsIsOverTheLimit) {
  SKIP_UNLESS(meshoptAvailable());
  GltfAsset asset = meshoptAsset();
  Json& view = asset.json["bufferViews"][1];
  view["extensions"]["EXT_meshopt_compression"]["count"] = 1ull << 40;
  view["byteLength"] = 12ull << 40;
  expectRefused<LimitError>(asset.glb(), {"/bufferViews/1"});
}

TEST(GltfCompressed, IndicesBeyondTheVerticesAreRefusedAfterUnpacking) {
  SKIP_UNLESS(meshoptAvailable());
  GltfAsset asset = meshoptAsset();
  asset.json["accessors"][0]["count"] = 20; // of 25
  asset.json["accessors"][2]["count"] = 20;
  expectRefused<SceneError>(asset.glb(), {"/accessors/4: ", "ACCESSOR_INDEX_OOB"});
}

// What the KHR extension has beyond the EXT one needs a newer decoder: then plain data beside it is used.
TEST(GltfCompressed, MeshoptOfNewerKindsNeedsPlainData) {
  SKIP_UNLESS(meshoptAvailable());
  GltfAsset color = meshoptAsset("KHR_meshopt_compression");
  Json& parameters = color.json["bufferViews"][1]["extensions"]["KHR_meshopt_compression"];
  const size_t header = parameters["byteOffset"].get<size_t>();
  parameters["filter"] = "COLOR";
  expectRefused<UnsupportedError>(color.glb(), {"/bufferViews/1/extensions/KHR_meshopt_compression"});
  GltfAsset version = meshoptAsset("KHR_meshopt_compression");
  version.data[header] = '\xa1';
  expectRefused<UnsupportedError>(version.glb(), {"/bufferViews/1/extensions/KHR_meshopt_compression"});

  const std::string plain = bytesOf(bentSheet(4).positions);
  version.json["buffers"][1] = {{"byteLength", plain.size()},
                                {"uri", "data:application/octet-stream;base64," + base64(plain)}};
  version.json["bufferViews"][1]["byteLength"] = plain.size();
  for (const size_t other : {3, 5, 7, 9, 11}) version.json["bufferViews"][other]["buffer"] = 2;
  version.json["buffers"].push_back(color.json["buffers"][1]);
  expectSheet(load(version.glb()).meshes[0].primitives[0], 4, 0);
}

TEST(GltfCompressed, BrokenWebpIsRefusedWithItsPointer) {
  SKIP_UNLESS(webpAvailable());
  GltfAsset cut = webpAsset();
  Json& view = cut.json["bufferViews"][cut.json["images"][0]["bufferView"].get<size_t>()];
  const size_t length = view["byteLength"].get<size_t>();
  view["byteLength"] = length - 8;
  expectRefused<SceneError>(cut, {"/images/0: ", "IMAGE_DATA_INVALID"});
  view["byteLength"] = 14;
  expectRefused<SceneError>(cut, {"/images/0: ", "header"});
  GltfAsset large = webpAsset();
  expectRefused<LimitError>(large, {"/images/0: ", "2 x 2 pixels"}, {.maxImagePixels = 3});
  GltfAsset lie = webpAsset();
  lie.json["images"][0]["mimeType"] = "image/png";
  expectRefused<SceneError>(lie, {"/images/0: ", "IMAGE_MIME_TYPE_INVALID"});
}
