// Tangents: closed forms on a plane, agreement with the files' own, and splitting at mirrored seams.
#include <cmath>

#include <gtest/gtest.h>

#include "scene/tangents.hpp"
#include "support/paths.hpp"
#include "unit/gltf_asset.hpp"
#include "unit/gltf_png.hpp"

using namespace isophote;
using namespace isophote::test;

namespace {

/// Two triangles over the unit square in z = 0, uv from `uvOf`.
template <class UvOf> Primitive square(const UvOf& uvOf) {
  Primitive primitive;
  primitive.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  primitive.normals.assign(4, glm::vec3(0, 0, 1));
  for (const glm::vec3 p : primitive.positions) primitive.uvs[0].push_back(uvOf(p));
  primitive.indices = {0, 1, 2, 0, 2, 3};
  return primitive;
}

void expectNear(glm::vec4 actual, glm::vec4 expected, float tolerance = 1e-6f) {
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(actual[i], expected[i], tolerance) << "component " << i;
}

GltfAsset normalMappedTriangle() {
  GltfAsset asset = texturedTriangleAsset();
  asset.add("textures", {{"source", asset.addImage(pngPixel(128, 128, 255, 255))}});
  asset.material()["normalTexture"] = {{"index", 0}};
  return asset;
}

} // namespace

TEST(Tangents, PointAlongUAndTheBitangentAgainstV) {
  // v = 1 - y: the image stands upright, so the normal map's y (up in the image) is +y: cross(n, t) w = (0, 1, 0).
  Primitive upright = square([](glm::vec3 p) { return glm::vec2(p.x, 1 - p.y); });
  generateTangents(upright, 0);
  for (const glm::vec4 tangent : upright.tangents) expectNear(tangent, {1, 0, 0, 1});
  Primitive flipped = square([](glm::vec3 p) { return glm::vec2(p.x, p.y); });
  generateTangents(flipped, 0);
  for (const glm::vec4 tangent : flipped.tangents) expectNear(tangent, {1, 0, 0, -1});
}

TEST(Tangents, FollowRotatedAndScaledTextureCoordinates) {
  const float angle = 0.7f;
  Primitive primitive = square([&](glm::vec3 p) {
    return glm::vec2(5 * (std::cos(angle) * p.x + std::sin(angle) * p.y),
                     std::sin(angle) * p.x - std::cos(angle) * p.y);
  });
  generateTangents(primitive, 0);
  for (const glm::vec4 tangent : primitive.tangents) {
    expectNear(tangent, {std::cos(angle), std::sin(angle), 0, 1});
  }
}

TEST(Tangents, AreUnitAndInThePlaneOfTheNormal) {
  Primitive primitive = square([](glm::vec3 p) { return glm::vec2(p.x + 0.3f * p.y, 2 * p.y); });
  const glm::vec3 normal = glm::normalize(glm::vec3(0.3f, 0.2f, 1));
  primitive.normals.assign(4, normal);
  generateTangents(primitive, 0);
  for (const glm::vec4 tangent : primitive.tangents) {
    EXPECT_NEAR(glm::length(glm::vec3(tangent)), 1, 1e-6);
    EXPECT_NEAR(glm::dot(glm::vec3(tangent), normal), 0, 1e-6);
  }
}

TEST(Tangents, AVertexBetweenMirroredTrianglesIsSplit) {
  // u mirrored at the diagonal 0-2: the triangles turn opposite ways in uv.
  Primitive primitive =
      square([](glm::vec3 p) { return p == glm::vec3(0, 1, 0) ? glm::vec2(1, 1) : glm::vec2(p.x, 1 - p.y); });
  generateTangents(primitive, 0);
  ASSERT_EQ(primitive.positions.size(), 6u);
  ASSERT_EQ(primitive.tangents.size(), 6u);
  EXPECT_EQ(primitive.normals.size(), 6u);
  EXPECT_EQ(primitive.uvs[0].size(), 6u);
  for (size_t corner = 0; corner < 6; ++corner) {
    EXPECT_EQ(primitive.tangents[primitive.indices[corner]].w, corner < 3 ? 1.0f : -1.0f) << corner;
  }
}

TEST(Tangents, CornersAreWeightedByTheirAngles) {
  // A fan around the origin: one triangle of 90 degrees with u along x, one of 45 degrees with u turned by 30.
  Primitive primitive;
  primitive.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 1, 0}};
  primitive.normals.assign(4, glm::vec3(0, 0, 1));
  primitive.indices = {0, 1, 2, 0, 2, 3};
  const float turn = glm::radians(30.0f);
  const auto turned = [&](glm::vec3 p) {
    return glm::vec2(std::cos(turn) * p.x + std::sin(turn) * p.y, std::sin(turn) * p.x - std::cos(turn) * p.y);
  };
  // Triangle 2 gets its own copies of the outer vertices, so that only the shared corner is averaged.
  primitive.positions.push_back(primitive.positions[2]);
  primitive.normals.emplace_back(0, 0, 1);
  primitive.indices = {0, 1, 2, 0, 4, 3};
  primitive.uvs[0] = {{0, 0}, {1, 0}, {0, -1}, turned({-1, 1, 0}), turned({0, 1, 0})};
  generateTangents(primitive, 0);
  const double sumX = 90 + 45 * std::cos(turn);
  const double sumY = 45 * std::sin(turn);
  const double length = std::hypot(sumX, sumY);
  expectNear(primitive.tangents[0], glm::vec4(sumX / length, sumY / length, 0, 1));
}

TEST(Tangents, VerticesThatDifferOnlyInIndexShareATangent) {
  // The same fan unwelded: six corners, the two at the origin still agree.
  Primitive primitive;
  primitive.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {0, 1, 0}, {-1, 0, 0}};
  primitive.normals.assign(6, glm::vec3(0, 0, 1));
  primitive.uvs[0] = {{0, 0}, {1, 0}, {0.5f, -1}, {0, 0}, {0.5f, -1}, {-1, 0.5f}};
  primitive.indices = {0, 1, 2, 3, 4, 5};
  generateTangents(primitive, 0);
  ASSERT_EQ(primitive.tangents.size(), 6u);
  expectNear(primitive.tangents[0], primitive.tangents[3], 0);
  EXPECT_GT(glm::length(glm::vec3(primitive.tangents[1] - primitive.tangents[0])), 1e-3f) << "others do differ";
}

TEST(Tangents, TrianglesWithoutUvAreaTakeAnyDirectionInThePlane) {
  Primitive primitive = square([](glm::vec3) { return glm::vec2(0.5f); });
  generateTangents(primitive, 0);
  for (const glm::vec4 tangent : primitive.tangents) {
    EXPECT_NEAR(glm::length(glm::vec3(tangent)), 1, 1e-6);
    EXPECT_NEAR(tangent.z, 0, 1e-6);
  }
}

TEST(Tangents, WithoutNormalsEachTriangleHasItsOwn) {
  // A roof: two triangles at right angles share an edge, their tangents lie in their own planes.
  Primitive primitive;
  primitive.positions = {{0, 0, 0}, {0, 1, 0}, {1, 0, 1}, {-1, 0, 1}};
  primitive.uvs[0] = {{0, 1}, {0, 0}, {1, 1}, {-1, 1}};
  primitive.indices = {0, 2, 1, 0, 1, 3};
  generateTangents(primitive, 0);
  ASSERT_EQ(primitive.positions.size(), 6u);
  EXPECT_TRUE(primitive.normals.empty());
  const float h = std::sqrt(0.5f);
  expectNear(primitive.tangents[primitive.indices[0]], {h, 0, h, 1});
  expectNear(primitive.tangents[primitive.indices[3]], {h, 0, -h, 1});
}

TEST(GltfTangents, AreGeneratedOnlyForNormalMaps) {
  EXPECT_TRUE(load(texturedTriangleAsset()).meshes[0].primitives[0].tangents.empty());
  const Scene scene = load(normalMappedTriangle());
  ASSERT_EQ(scene.meshes[0].primitives[0].tangents.size(), 3u);
  expectNear(scene.meshes[0].primitives[0].tangents[0], {1, 0, 0, -1});
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(GltfTangents, OfTheFileAreKept) {
  GltfAsset asset = normalMappedTriangle();
  asset.attribute("NORMAL") = asset.addFloats({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  asset.attribute("TANGENT") = asset.addFloats({0, 2, 0, 1, 0, 1, 0, -1, 0, 1, 0, 1}, "VEC4");
  const Scene scene = load(asset);
  expectNear(scene.meshes[0].primitives[0].tangents[0], {0, 1, 0, 1}, 0);
  expectNear(scene.meshes[0].primitives[0].tangents[1], {0, 1, 0, -1}, 0);
}

TEST(GltfTangents, OfTheFileAreRecomputedWhereTheyCannotBeTrusted) {
  GltfAsset asset = normalMappedTriangle();
  asset.attribute("NORMAL") = asset.addFloats({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  asset.attribute("TANGENT") = asset.addFloats({0, 1, 0, 0.5f, 0, 0, 0, 1, 0, 1, 0, 1}, "VEC4");
  const Scene scene = load(asset);
  expectNear(scene.meshes[0].primitives[0].tangents[0], {1, 0, 0, -1});
  EXPECT_TRUE(warns(scene, "are recomputed (2 times"));
}

TEST(GltfTangents, WithoutTextureCoordinatesTheNormalTextureIsLeftOut) {
  GltfAsset asset = normalMappedTriangle();
  asset.primitive()["attributes"].erase("TEXCOORD_0");
  asset.json["meshes"][0]["primitives"].push_back(asset.primitive());
  asset.json["meshes"][0]["primitives"][1]["attributes"]["TEXCOORD_0"] = 1;
  const Scene scene = load(asset);
  const std::vector<Primitive>& primitives = scene.meshes[0].primitives;
  EXPECT_FALSE(scene.materials[primitives[0].material].normalTexture.present());
  EXPECT_TRUE(primitives[0].tangents.empty());
  EXPECT_TRUE(scene.materials[primitives[1].material].normalTexture.present());
  EXPECT_EQ(primitives[1].tangents.size(), 3u);
  EXPECT_TRUE(warns(scene, "a normal texture is left out"));
}

// The FlightHelmet comes with tangents by an exporter that follows MikkTSpace. Ours have to agree but where the
// exporter welded or split vertices differently. A wrong sign or handedness would disagree everywhere.
TEST(GltfTangents, AgreeWithThoseOfFlightHelmet) {
  const auto shared = sharedFolder();
  if (!shared) GTEST_SKIP() << "the sample models beside the checkout are absent";
  const Scene scene = loadGltf(*shared / "gltf/FlightHelmet/FlightHelmet.gltf");
  size_t corners = 0;
  size_t agreeing = 0;
  for (const Mesh& mesh : scene.meshes) {
    for (const Primitive& original : mesh.primitives) {
      Primitive generated = original;
      generated.tangents.clear();
      generateTangents(generated, scene.materials[original.material].normalTexture.uvSet);
      for (size_t corner = 0; corner < original.indices.size(); ++corner) {
        const glm::vec4 theirs = original.tangents[original.indices[corner]];
        const glm::vec4 ours = generated.tangents[generated.indices[corner]];
        const float cosine = glm::dot(glm::normalize(glm::vec3(theirs)), glm::vec3(ours));
        ++corners;
        if (cosine > std::cos(glm::radians(10.0f)) && theirs.w == ours.w) ++agreeing;
      }
    }
  }
  EXPECT_GT(corners, 250'000u);
  EXPECT_GT(static_cast<double>(agreeing) / static_cast<double>(corners), 0.95);
  RecordProperty("agreeing_percent", static_cast<int>(100 * agreeing / corners));
}
