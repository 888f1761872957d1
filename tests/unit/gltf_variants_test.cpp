// KHR_materials_variants: named, chosen, defaulted and refused.
#include <gtest/gtest.h>

#include "isophote/error.hpp"
#include "robustness/refusal.hpp"
#include "unit/gltf_asset.hpp"

using namespace isophote;
using namespace isophote::test;

namespace {

/// Material i has red i / 10. `green` and `blue` map to materials 1 and 2, `plain` to none.
GltfAsset assetWithVariants() {
  GltfAsset asset = triangleAsset();
  for (const double red : {0.0, 0.1, 0.2}) {
    asset.add("materials", {{"pbrMetallicRoughness", {{"baseColorFactor", {red, 0, 0, 1}}}}});
  }
  asset.primitive()["material"] = 0;
  asset.json["extensionsUsed"] = {"KHR_materials_variants"};
  asset.json["extensions"]["KHR_materials_variants"]["variants"] = {
      {{"name", "green"}}, {{"name", "blue"}}, {{"name", "plain"}}};
  asset.primitive()["extensions"]["KHR_materials_variants"]["mappings"] = {{{"material", 1}, {"variants", {0}}},
                                                                           {{"material", 2}, {"variants", {1}}}};
  return asset;
}

float redOf(const Scene& scene) { return scene.materials[scene.meshes[0].primitives[0].material].baseColor.r; }

} // namespace

TEST(GltfVariants, EachNameChoosesItsMaterial) {
  const GltfAsset asset = assetWithVariants();
  EXPECT_EQ(redOf(load(asset)), 0.0f);
  EXPECT_EQ(redOf(load(asset, {.variant = "green"})), 0.1f);
  EXPECT_EQ(redOf(load(asset, {.variant = "blue"})), 0.2f);
  EXPECT_EQ(redOf(load(asset, {.variant = "plain"})), 0.0f);
  const TemporaryFolder folder;
  EXPECT_EQ(gltfVariants(folder.write("asset.gltf", asset.gltf())),
            (std::vector<std::string>{"green", "blue", "plain"}));
  EXPECT_TRUE(load(asset).extensionsIgnored.empty());
}

TEST(GltfVariants, UnknownNamesAreRefusedWithThoseThereAre) {
  const std::string message = refusalOf<UsageError>(TemporaryFolder(), assetWithVariants().gltf(), {.variant = "red"});
  EXPECT_NE(message.find("no variant 'red'; there are: green, blue, plain"), std::string::npos) << message;
  expectRefused<UsageError>(triangleAsset(), {"the asset has none"}, {.variant = "red"});
}

TEST(GltfVariants, BrokenListsAreRefused) {
  const auto refused = [](const auto& change, const char* pointer) {
    GltfAsset asset = assetWithVariants();
    change(asset.json["extensions"]["KHR_materials_variants"],
           asset.primitive()["extensions"]["KHR_materials_variants"]["mappings"]);
    expectRefused<SceneError>(asset, {pointer});
  };
  const char* mapping = "/meshes/0/primitives/0/extensions/KHR_materials_variants/mappings/0";
  refused([](Json&, Json& mappings) { mappings[0]["variants"] = {3}; }, mapping);
  refused([](Json&, Json& mappings) { mappings[0]["material"] = 9; }, mapping);
  refused([](Json&, Json& mappings) { mappings[0].erase("variants"); }, mapping);
  refused([](Json& root, Json&) { root["variants"][1].erase("name"); },
          "/extensions/KHR_materials_variants/variants/1");
  refused([](Json& root, Json&) { root["variants"] = Json::object(); }, "/extensions/KHR_materials_variants/variants");
}
