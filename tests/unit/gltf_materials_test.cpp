// Every material property, its default, and what happens outside its range.
#include <cmath>

#include <gtest/gtest.h>

#include "isophote/error.hpp"
#include "unit/gltf_asset.hpp"
#include "unit/gltf_png.hpp"

using namespace isophote;
using namespace isophote::test;

namespace {

Scene loadMaterial(const Json& material) {
  GltfAsset asset = texturedTriangleAsset();
  asset.material() = material;
  return load(asset);
}

/// Four textures of four images; texture i is a pixel of red i.
GltfAsset assetWithTextures(const Json& material) {
  GltfAsset asset = texturedTriangleAsset();
  asset.material() = material;
  for (uint8_t i = 0; i < 18; ++i) asset.add("textures", {{"source", asset.addImage(pngPixel(i, 0, 0, 255))}});
  return asset;
}

/// The red of the image behind a reference: tells which texture it is.
int redOf(const Scene& scene, const TextureRef& ref) {
  if (!ref.present()) return -1;
  const Texture& texture = scene.textures.at(static_cast<size_t>(ref.texture));
  return std::to_integer<int>(scene.images.at(texture.image).pixels.at(0));
}

} // namespace

TEST(GltfMaterials, DefaultsAreThoseOfTheSpecification) {
  for (const Scene& scene : {load(triangleAsset()), loadMaterial(Json::object())}) {
    ASSERT_EQ(scene.materials.size(), 1u);
    const Material& m = scene.materials[0];
    EXPECT_EQ(m.baseColor, glm::vec4(1));
    EXPECT_EQ(m.metallic, 1);
    EXPECT_EQ(m.roughness, 1);
    EXPECT_EQ(m.emissive, glm::vec3(0));
    EXPECT_EQ(m.ior, 1.5f);
    EXPECT_EQ(m.specular, 1);
    EXPECT_EQ(m.specularColor, glm::vec3(1));
    EXPECT_EQ(m.alphaMode, AlphaMode::Opaque);
    EXPECT_EQ(m.alphaCutoff, 0.5f);
    EXPECT_FALSE(m.doubleSided);
    EXPECT_FALSE(m.unlit);
  }
}

TEST(GltfMaterials, FactorsAreRead) {
  const Scene scene =
      loadMaterial({{"name", "brass"},
                    {"alphaCutoff", 0.25},
                    {"alphaMode", "MASK"},
                    {"doubleSided", true},
                    {"emissiveFactor", {0.5, 0.25, 0}},
                    {"pbrMetallicRoughness",
                     {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}}, {"metallicFactor", 0.6}, {"roughnessFactor", 0.7}}},
                    {"extensions",
                     {{"KHR_materials_emissive_strength", {{"emissiveStrength", 8}}},
                      {"KHR_materials_ior", {{"ior", 1.33}}},
                      {"KHR_materials_specular", {{"specularFactor", 0.9}, {"specularColorFactor", {1, 2, 0.5}}}}}}});
  const Material& m = scene.materials.at(0);
  EXPECT_EQ(m.name, "brass");
  EXPECT_EQ(m.baseColor, glm::vec4(0.1f, 0.2f, 0.3f, 0.4f));
  EXPECT_EQ(m.metallic, 0.6f);
  EXPECT_EQ(m.roughness, 0.7f);
  EXPECT_EQ(m.emissive, glm::vec3(4, 2, 0));
  EXPECT_EQ(m.ior, 1.33f);
  EXPECT_EQ(m.specular, 0.9f);
  EXPECT_EQ(m.specularColor, glm::vec3(1, 2, 0.5f));
  EXPECT_EQ(m.alphaMode, AlphaMode::Mask);
  EXPECT_EQ(m.alphaCutoff, 0.25f);
  EXPECT_TRUE(m.doubleSided);
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(GltfMaterials, EveryTextureGoesToItsPlace) {
  const Scene scene = load(assetWithTextures(
      {{"emissiveTexture", {{"index", 3}}},
       {"normalTexture", {{"index", 2}, {"scale", 0.5}}},
       {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}, {"metallicRoughnessTexture", {{"index", 1}}}}},
       {"extensions",
        {{"KHR_materials_specular",
          {{"specularTexture", {{"index", 4}}}, {"specularColorTexture", {{"index", 5}}}}}}}}));
  const Material& m = scene.materials.at(0);
  EXPECT_EQ(redOf(scene, m.baseColorTexture), 0);
  EXPECT_EQ(redOf(scene, m.metallicRoughnessTexture), 1);
  EXPECT_EQ(redOf(scene, m.normalTexture), 2);
  EXPECT_EQ(redOf(scene, m.emissiveTexture), 3);
  EXPECT_EQ(redOf(scene, m.specularTexture), 4);
  EXPECT_EQ(redOf(scene, m.specularColorTexture), 5);
  EXPECT_EQ(m.normalTexture.scale, 0.5f);
  EXPECT_EQ(m.baseColorTexture.scale, 1.0f);
}

TEST(GltfMaterials, ExtensionFactorsAreRead) {
  const Scene scene = loadMaterial(
      {{"extensions",
        {{"KHR_materials_clearcoat", {{"clearcoatFactor", 0.5}, {"clearcoatRoughnessFactor", 0.25}}},
         {"KHR_materials_sheen", {{"sheenColorFactor", {0.1, 0.2, 0.3}}, {"sheenRoughnessFactor", 0.75}}},
         {"KHR_materials_anisotropy", {{"anisotropyStrength", 0.6}, {"anisotropyRotation", 7}}},
         {"KHR_materials_iridescence",
          {{"iridescenceFactor", 0.8},
           {"iridescenceIor", 1.8},
           {"iridescenceThicknessMinimum", 10},
           {"iridescenceThicknessMaximum", 5}}},
         {"KHR_materials_transmission", {{"transmissionFactor", 0.9}}},
         {"KHR_materials_diffuse_transmission",
          {{"diffuseTransmissionFactor", 0.35}, {"diffuseTransmissionColorFactor", {1, 0.5, 0}}}},
         {"KHR_materials_volume",
          {{"thicknessFactor", 2}, {"attenuationDistance", 3}, {"attenuationColor", {0.5, 1, 0}}}},
         {"KHR_materials_volume_scatter", {{"multiscatterColor", {0.5, 0.25, 1}}, {"scatterAnisotropy", -0.5}}},
         {"KHR_materials_dispersion", {{"dispersion", 0.1}}}}}});
  const Material& m = scene.materials.at(0);
  EXPECT_EQ(m.clearcoat.factor, 0.5f);
  EXPECT_EQ(m.clearcoat.roughness, 0.25f);
  EXPECT_EQ(m.sheen.color, glm::vec3(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(m.sheen.roughness, 0.75f);
  EXPECT_EQ(m.anisotropy.strength, 0.6f);
  EXPECT_EQ(m.anisotropy.rotation, 7);
  EXPECT_EQ(m.iridescence.factor, 0.8f);
  EXPECT_EQ(m.iridescence.ior, 1.8f);
  EXPECT_EQ(m.iridescence.thicknessMinimum, 10);
  EXPECT_EQ(m.iridescence.thicknessMaximum, 5) << "the extension allows a minimum above the maximum";
  EXPECT_EQ(m.transmission.factor, 0.9f);
  EXPECT_EQ(m.diffuseTransmission.factor, 0.35f);
  EXPECT_EQ(m.diffuseTransmission.color, glm::vec3(1, 0.5f, 0));
  EXPECT_EQ(m.volume.thickness, 2);
  EXPECT_EQ(m.volume.attenuationDistance, 3);
  EXPECT_EQ(m.volume.attenuationColor, glm::vec3(0.5f, 1, 0));
  EXPECT_EQ(m.volume.multiscatterColor, glm::vec3(0.5f, 0.25f, 1));
  EXPECT_EQ(m.volume.scatterAnisotropy, -0.5f);
  EXPECT_EQ(m.dispersion, 0.1f);
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(GltfMaterials, EveryExtensionTextureGoesToItsPlace) {
  const Scene scene = load(assetWithTextures(
      {{"extensions",
        {{"KHR_materials_clearcoat",
          {{"clearcoatTexture", {{"index", 6}}},
           {"clearcoatRoughnessTexture", {{"index", 7}}},
           {"clearcoatNormalTexture", {{"index", 8}, {"scale", 2}}}}},
         {"KHR_materials_sheen", {{"sheenColorTexture", {{"index", 9}}}, {"sheenRoughnessTexture", {{"index", 10}}}}},
         {"KHR_materials_anisotropy", {{"anisotropyTexture", {{"index", 11}}}}},
         {"KHR_materials_iridescence",
          {{"iridescenceTexture", {{"index", 12}}}, {"iridescenceThicknessTexture", {{"index", 13}}}}},
         {"KHR_materials_transmission", {{"transmissionTexture", {{"index", 14}}}}},
         {"KHR_materials_diffuse_transmission",
          {{"diffuseTransmissionTexture", {{"index", 15}}}, {"diffuseTransmissionColorTexture", {{"index", 16}}}}},
         {"KHR_materials_volume", {{"thicknessTexture", {{"index", 17}}}}}}}}));
  const Material& m = scene.materials.at(0);
  EXPECT_EQ(redOf(scene, m.clearcoat.texture), 6);
  EXPECT_EQ(redOf(scene, m.clearcoat.roughnessTexture), 7);
  EXPECT_EQ(redOf(scene, m.clearcoat.normalTexture), 8);
  EXPECT_EQ(m.clearcoat.normalTexture.scale, 2);
  EXPECT_EQ(redOf(scene, m.sheen.colorTexture), 9);
  EXPECT_EQ(redOf(scene, m.sheen.roughnessTexture), 10);
  EXPECT_EQ(redOf(scene, m.anisotropy.texture), 11);
  EXPECT_EQ(redOf(scene, m.iridescence.texture), 12);
  EXPECT_EQ(redOf(scene, m.iridescence.thicknessTexture), 13);
  EXPECT_EQ(redOf(scene, m.transmission.texture), 14);
  EXPECT_EQ(redOf(scene, m.diffuseTransmission.texture), 15);
  EXPECT_EQ(redOf(scene, m.diffuseTransmission.colorTexture), 16);
  EXPECT_EQ(redOf(scene, m.volume.thicknessTexture), 17);
}

TEST(GltfMaterials, UnlitKeepsBaseColorOnly) {
  const Scene scene = load(assetWithTextures(
      {{"alphaMode", "BLEND"},
       {"emissiveFactor", {1, 1, 1}},
       {"emissiveTexture", {{"index", 3}}},
       {"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.5, 0.5, 0.5}}, {"baseColorTexture", {{"index", 4}}}}},
       {"extensions", {{"KHR_materials_unlit", Json::object()}}}}));
  const Material& m = scene.materials.at(0);
  EXPECT_TRUE(m.unlit);
  EXPECT_EQ(m.alphaMode, AlphaMode::Blend);
  EXPECT_EQ(m.baseColor, glm::vec4(0.5f));
  EXPECT_EQ(redOf(scene, m.baseColorTexture), 4);
  EXPECT_EQ(m.emissive, glm::vec3(0));
  EXPECT_FALSE(m.emissiveTexture.present());
  EXPECT_EQ(scene.images.size(), 1u);
}

TEST(GltfMaterials, AnIorOfZeroMeansAReflectanceOfOne) {
  const Scene scene = loadMaterial({{"extensions", {{"KHR_materials_ior", {{"ior", 0}}}}}});
  const float ior = scene.materials.at(0).ior;
  EXPECT_EQ(std::pow((ior - 1) / (ior + 1), 2.0f), 1.0f);
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(GltfMaterials, OutOfRangeValuesAreClampedWithOneWarningEach) {
  const Scene scene =
      loadMaterial({{"alphaCutoff", -1},
                    {"emissiveFactor", {2, -1, 0.5}},
                    {"pbrMetallicRoughness",
                     {{"baseColorFactor", {1.5, -0.5, 0.5, 2}}, {"metallicFactor", -1}, {"roughnessFactor", 3}}},
                    {"extensions",
                     {{"KHR_materials_emissive_strength", {{"emissiveStrength", 1e30}}},
                      {"KHR_materials_ior", {{"ior", 0.5}}},
                      {"KHR_materials_specular", {{"specularFactor", 4}, {"specularColorFactor", {-1, 3, 0}}}}}}});
  const Material& m = scene.materials.at(0);
  EXPECT_EQ(m.baseColor, glm::vec4(1, 0, 0.5f, 1));
  EXPECT_EQ(m.metallic, 0);
  EXPECT_EQ(m.roughness, 1);
  EXPECT_EQ(m.emissive, glm::vec3(1e18f, 0, 0.5e18f));
  EXPECT_EQ(m.alphaCutoff, 0);
  EXPECT_EQ(m.ior, 1);
  EXPECT_EQ(m.specular, 1);
  EXPECT_EQ(m.specularColor, glm::vec3(0, 3, 0));
  EXPECT_EQ(scene.warnings.size(), 9u);
}

TEST(GltfMaterials, TextureTransformFollowsTheExtensionsExample) {
  // KHR_texture_transform's own example: "utilizes only the lower left quadrant of the source image, rotated".
  const Json transform = {{"offset", {0, 1}}, {"rotation", 1.57079632679}, {"scale", {0.5, 0.5}}};
  const Scene scene = load(
      assetWithTextures({{"emissiveTexture", {{"index", 0}, {"extensions", {{"KHR_texture_transform", transform}}}}}}));
  const TextureRef& ref = scene.materials.at(0).emissiveTexture;
  const auto apply = [&](float u, float v) {
    return glm::vec2(glm::dot(ref.uRow, glm::vec3(u, v, 1)), glm::dot(ref.vRow, glm::vec3(u, v, 1)));
  };
  const auto expectNear = [](glm::vec2 actual, glm::vec2 expected) {
    EXPECT_NEAR(actual.x, expected.x, 1e-6);
    EXPECT_NEAR(actual.y, expected.y, 1e-6);
  };
  expectNear(apply(0, 0), {0, 1});
  expectNear(apply(1, 0), {0, 0.5f});
  expectNear(apply(0, 1), {0.5f, 1});
  expectNear(apply(1, 1), {0.5f, 0.5f});
}

TEST(GltfMaterials, TextureTransformMayChooseTheUvSet) {
  GltfAsset asset = assetWithTextures(
      {{"emissiveTexture",
        {{"index", 0}, {"texCoord", 0}, {"extensions", {{"KHR_texture_transform", {{"texCoord", 2}}}}}}},
       {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 1}, {"texCoord", 3}}}}}});
  const Scene scene = load(asset);
  EXPECT_EQ(scene.materials.at(0).emissiveTexture.uvSet, 2u);
  EXPECT_EQ(scene.materials.at(0).baseColorTexture.uvSet, 3u);
  EXPECT_EQ(scene.meshes[0].primitives[0].uvs[2].size(), 3u) << "absent coordinates are taken as 0";
  EXPECT_TRUE(warns(scene, "missing texture coordinates are taken as 0"));
}

TEST(GltfMaterials, UvSetsBeyondTheFourthAreLeftOut) {
  const Scene scene = load(assetWithTextures({{"emissiveTexture", {{"index", 0}, {"texCoord", 4}}}}));
  EXPECT_FALSE(scene.materials.at(0).emissiveTexture.present());
  EXPECT_TRUE(warns(scene, "UV set above 3"));
}

TEST(GltfMaterials, OnlyMaterialsThatAreDrawnEnterTheScene) {
  GltfAsset asset = triangleAsset();
  asset.json["materials"] = {{{"name", "unused"}}, {{"name", "used"}}};
  asset.primitive()["material"] = 1;
  const Scene scene = load(asset);
  ASSERT_EQ(scene.materials.size(), 1u);
  EXPECT_EQ(scene.materials[0].name, "used");
}

TEST(GltfMaterials, UnknownAlphaModesAreRefused) {
  EXPECT_THROW((void)loadMaterial({{"alphaMode", "ADD"}}), SceneError);
}

// Diffuse 0.8 under a reflectance of 0.2 at normal incidence; glossiness 0.75 is roughness 0.25.
TEST(GltfMaterials, SpecularGlossinessIsReadAsADielectricOfThatReflectance) {
  const Scene scene = loadMaterial({{"pbrMetallicRoughness", {{"metallicFactor", 1}}},
                                    {"extensions",
                                     {{"KHR_materials_pbrSpecularGlossiness",
                                       {{"diffuseFactor", {0.8, 0.7, 0.6, 0.5}},
                                        {"specularFactor", {0.2, 0.3, 0.4}},
                                        {"glossinessFactor", 0.75}}}}}});
  const Material& m = scene.materials.at(0);
  EXPECT_EQ(m.baseColor, glm::vec4(0.8f, 0.7f, 0.6f, 0.5f));
  EXPECT_EQ(m.metallic, 0);
  EXPECT_EQ(m.roughness, 0.25f);
  EXPECT_EQ(m.ior, 0);
  EXPECT_EQ(m.specular, 1);
  EXPECT_EQ(m.specularColor, glm::vec3(0.2f, 0.3f, 0.4f));
}

// Alpha 51 is glossiness 0.2 times 0.5: roughness 0.9.
TEST(GltfMaterials, GlossinessOfATextureBecomesRoughness) {
  GltfAsset asset = texturedTriangleAsset();
  asset.add("textures", {{"source", asset.addImage(pngPixel(9, 8, 7, 51))}});
  asset.material()["extensions"]["KHR_materials_pbrSpecularGlossiness"] = {
      {"glossinessFactor", 0.5}, {"specularGlossinessTexture", {{"index", 0}}}};
  const Scene scene = load(asset);
  const Material& m = scene.materials.at(0);
  EXPECT_EQ(m.roughness, 1);
  EXPECT_EQ(redOf(scene, m.specularColorTexture), 9);
  const Texture& roughness = scene.textures.at(static_cast<size_t>(m.metallicRoughnessTexture.texture));
  EXPECT_EQ(std::to_integer<int>(scene.images.at(roughness.image).pixels.at(1)), 230); // 0.9 * 255 rounded
}
