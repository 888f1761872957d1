#include <gtest/gtest.h>

#include "isophote/features.hpp"

using namespace isophote;

namespace {

/// One instanced triangle with a diffuse material that needs no feature.
Scene plainScene() {
  Material material;
  material.metallic = 0;
  material.specular = 0;
  Primitive triangle;
  triangle.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  triangle.indices = {0, 1, 2};
  Scene scene;
  scene.materials = {material};
  scene.meshes = {Mesh{.primitives = {triangle}}};
  scene.instances = {Instance{}};
  return scene;
}

std::vector<std::string> names(const Scene& scene) { return sceneFeatures(scene).names(); }
using Names = std::vector<std::string>;

/// Two texels: one with the given green, one white.
void addRoughnessTexture(Scene& scene, uint32_t bits, uint32_t green) {
  const uint32_t white = (1u << bits) - 1;
  ImageData image{.width = 2, .height = 1, .bitsPerChannel = bits};
  for (const uint32_t value : {0u, green, 0u, 0u, white, white, white, white}) {
    image.pixels.push_back(static_cast<std::byte>(value & 0xff));
    if (bits == 16) image.pixels.push_back(static_cast<std::byte>(value >> 8));
  }
  scene.images = {image};
  scene.textures = {Texture{.image = 0}};
  scene.materials[0].metallicRoughnessTexture.texture = 0;
}

} // namespace

TEST(Features, EveryFeatureHasItsOwnBitAndName) {
  uint32_t bits = 0;
  Names seen;
  for (const auto& description : allFeatures()) {
    bits |= 1u << static_cast<uint32_t>(description.feature);
    seen.emplace_back(description.name);
  }
  EXPECT_EQ(FeatureSet::all().bits(), bits);
  EXPECT_EQ(FeatureSet::all().names(), seen);
  EXPECT_EQ(static_cast<size_t>(__builtin_popcount(bits)), allFeatures().size());
  EXPECT_EQ(bits & 1u, 0u) << "id 0 is the workgroup size";
}

TEST(Features, APlainDiffuseSceneNeedsNone) { EXPECT_EQ(names(plainScene()), Names{}); }

TEST(Features, EachThingInTheSceneAddsItsFeatureAlone) {
  const std::vector<std::pair<std::string, void (*)(Scene&)>> cases{
      {"shading-normals",
       [](Scene& s) {
         s.meshes[0].primitives[0].normals.assign(3, {0, 0, 1});
       }},
      {"vertex-colors",
       [](Scene& s) {
         s.meshes[0].primitives[0].colors.assign(3, {1, 1, 1, 1});
       }},
      {"alpha", [](Scene& s) { s.materials[0].alphaMode = AlphaMode::Mask; }},
      {"emissive-triangles",
       [](Scene& s) {
         s.materials[0].emissive = {0, 1, 0};
       }},
      {"punctual-lights", [](Scene& s) { s.lights.emplace_back(); }},
      {"sphere-lights", [](Scene& s) { s.lights.emplace_back().radius = 1; }},
      {"suns",
       [](Scene& s) {
         s.lights.emplace_back().radius = 0.01f;
         s.lights[0].kind = LightKind::Directional;
       }},
      {"environment", [](Scene& s) { s.environment.emplace(); }},
      {"specular", [](Scene& s) { s.materials[0].specular = 1; }},
      {"specular", [](Scene& s) { s.materials[0].metallic = 1; }},
      {"clearcoat", [](Scene& s) { s.materials[0].clearcoat.factor = 0.1f; }},
      {"sheen",
       [](Scene& s) {
         s.materials[0].sheen.color = {0, 0.1f, 0};
       }},
      {"diffuse-transmission", [](Scene& s) { s.materials[0].diffuseTransmission.factor = 0.1f; }},
      {"unlit", [](Scene& s) { s.materials[0].unlit = true; }},
  };
  // Glass is made of facets.
  Scene glass = plainScene();
  glass.materials[0].transmission.factor = 0.5f;
  EXPECT_EQ(names(glass), (Names{"specular", "transmission"}));
  // So is what only facets have.
  Scene film = plainScene();
  film.materials[0].iridescence.factor = 0.5f;
  EXPECT_EQ(names(film), (Names{"specular", "iridescence"}));
  Scene brushed = plainScene();
  brushed.materials[0].metallic = 1;
  brushed.materials[0].anisotropy.strength = 0.5f;
  brushed.materials[0].conductor.given = true;
  EXPECT_EQ(names(brushed), (Names{"specular", "anisotropy", "conductor"}));
  for (const auto& [name, change] : cases) {
    Scene scene = plainScene();
    change(scene);
    EXPECT_EQ(names(scene), Names{name});
  }
}

TEST(Features, ATextureOfAnyKindNeedsTextures) {
  for (const auto member : {&Material::baseColorTexture, &Material::metallicRoughnessTexture,
                            &Material::emissiveTexture, &Material::specularTexture, &Material::specularColorTexture}) {
    Scene scene = plainScene();
    addRoughnessTexture(scene, 8, 255);
    scene.materials[0].metallicRoughnessTexture.texture = kNone;
    (scene.materials[0].*member).texture = 0;
    EXPECT_EQ(names(scene), Names{"textures"});
  }
  Scene scene = plainScene();
  scene.materials[0].normalTexture.texture = 0;
  EXPECT_EQ(names(scene), (Names{"textures", "normal-maps"}));
}

TEST(Features, OnlySmoothSurfacesNeedTheMirror) {
  Scene scene = plainScene();
  scene.materials[0].metallic = 1;
  scene.materials[0].roughness = 0.00725f; // alpha 5.26e-5
  EXPECT_EQ(names(scene), Names{"specular"});
  scene.materials[0].roughness = 0.00706f; // alpha 4.98e-5
  EXPECT_EQ(names(scene), (Names{"specular", "mirror"}));
}

TEST(Features, ARoughnessTextureNeedsTheMirrorWhereItsSmallestTexelDoes) {
  for (const uint32_t bits : {8u, 16u}) {
    const double full = bits == 8 ? 255 : 65535;
    Scene scene = plainScene();
    scene.materials[0].metallic = 1;
    addRoughnessTexture(scene, bits, static_cast<uint32_t>(0.2 * full));
    EXPECT_EQ(names(scene), (Names{"textures", "specular"})) << bits;
    scene.materials[0].roughness = 0.03f; // times 0.2
    EXPECT_EQ(names(scene), (Names{"textures", "specular", "mirror"})) << bits;
  }
}

TEST(Features, WhatNoInstanceUsesNeedsNothing) {
  Scene scene = plainScene();
  Material glowing;
  glowing.emissive = {1, 1, 1};
  scene.materials.push_back(glowing);
  scene.meshes.push_back(scene.meshes[0]);
  scene.meshes[1].primitives[0].material = 1;
  scene.meshes[1].primitives[0].normals.assign(3, {0, 0, 1});
  EXPECT_EQ(names(scene), Names{});
  scene.instances.push_back(Instance{.mesh = 1});
  EXPECT_EQ(names(scene), (Names{"shading-normals", "emissive-triangles", "specular"}));
}
