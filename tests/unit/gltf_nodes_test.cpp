// Transforms, scenes, instancing, visibility, cameras and lights.
#include <cmath>

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "isophote/error.hpp"
#include "unit/gltf_asset.hpp"

using namespace isophote;
using namespace isophote::test;

namespace {

GltfAsset withNodes(const Json& nodes, const std::vector<int>& roots = {0}) {
  GltfAsset asset = triangleAsset();
  asset.json["nodes"] = nodes;
  asset.json["scenes"] = {{{"nodes", roots}}};
  return asset;
}

glm::dvec3 transformed(const Instance& instance, glm::dvec3 point) {
  return glm::dvec3(instance.worldFromObject * glm::dvec4(point, 1));
}

void expectNear(glm::dvec3 actual, glm::dvec3 expected, double tolerance = 1e-12) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(actual[i], expected[i], tolerance) << "component " << i;
}

const double kHalf = std::sqrt(0.5);

} // namespace

TEST(GltfNodes, TranslationRotationAndScaleApplyFromRightToLeft) {
  // scale 2, then a quarter turn about z, then up by 10
  const Scene scene = load(withNodes({{{"mesh", 0},
                                       {"name", "node"},
                                       {"translation", {0, 10, 0}},
                                       {"rotation", {0, 0, kHalf, kHalf}},
                                       {"scale", {2, 2, 2}}}}));
  ASSERT_EQ(scene.instances.size(), 1u);
  EXPECT_EQ(scene.instances[0].name, "node");
  expectNear(transformed(scene.instances[0], {1, 0, 0}), {0, 12, 0});
}

TEST(GltfNodes, MatricesAreColumnMajorAndKeepShear) {
  const Scene scene = load(withNodes({{{"mesh", 0}, {"matrix", {1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, 1, 0, 7, 8, 9, 1}}}}));
  expectNear(transformed(scene.instances.at(0), {0, 2, 0}), {8, 10, 9});
}

TEST(GltfNodes, MirroredTransformsAreKept) {
  const Scene scene = load(withNodes({{{"mesh", 0}, {"scale", {-1, 1, 1}}}}));
  EXPECT_LT(glm::determinant(scene.instances.at(0).worldFromObject), 0);
}

TEST(GltfNodes, ParentsAreAccumulatedInDouble) {
  // 1e9 + 1e-3 - 1e9: single precision would give 0
  const Scene scene = load(withNodes({{{"children", {1}}, {"translation", {1e9, 0, 0}}},
                                      {{"children", {2}}, {"translation", {1e-3, 0, 0}}},
                                      {{"mesh", 0}, {"translation", {-1e9, 0, 0}}}}));
  expectNear(transformed(scene.instances.at(0), {0, 0, 0}), {1e-3, 0, 0}, 1e-6);
}

TEST(GltfNodes, SingularTransformsAreSkippedWithAWarning) {
  const Scene scene = load(withNodes({{{"mesh", 0}, {"scale", {1, 0, 1}}},
                                      {{"mesh", 0}, {"matrix", {1, 2, 3, 0, 2, 4, 6, 0, 0, 0, 1, 0, 0, 0, 0, 1}}},
                                      {{"mesh", 0}, {"scale", {1e-9, 1e-9, 1e-9}}}},
                                     {0, 1, 2}));
  EXPECT_EQ(scene.instances.size(), 1u) << "small is not singular";
  EXPECT_TRUE(warns(scene, "singular transform is skipped (2 times, first at /nodes/0)"));
}

TEST(GltfNodes, OddQuaternionsAreNormalizedWithAWarning) {
  const Scene scene =
      load(withNodes({{{"mesh", 0}, {"rotation", {0, 0, 3, 3}}}, {{"mesh", 0}, {"rotation", {0, 0, 0, 0}}}}, {0, 1}));
  expectNear(transformed(scene.instances.at(0), {1, 0, 0}), {0, 1, 0});
  expectNear(transformed(scene.instances.at(1), {1, 0, 0}), {1, 0, 0});
  EXPECT_TRUE(warns(scene, "not unit quaternions are normalized (2 times"));
}

TEST(GltfNodes, AChainOfAMillionNodesIsWalkedWithoutRecursion) {
  constexpr int kCount = 1'000'000;
  std::string nodes = R"({"children":[1]})";
  for (int i = 2; i < kCount; ++i) nodes += R"(,{"children":[)" + std::to_string(i) + "]}";
  std::string text = withNodes("NODES").gltf();
  text.replace(text.find("\"NODES\""), 7, "[" + nodes + R"(,{"mesh":0}])");
  EXPECT_EQ(load(text).instances.size(), 1u);
}

TEST(GltfNodes, SceneIsChosenByOptionDefaultOrFirst) {
  GltfAsset asset = withNodes({{{"mesh", 0}, {"name", "a"}}, {{"mesh", 0}, {"name", "b"}}});
  asset.json["scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}}, Json::object()};
  EXPECT_EQ(load(asset).instances.at(0).name, "a");
  asset.json["scene"] = 1;
  EXPECT_EQ(load(asset).instances.at(0).name, "b");
  EXPECT_EQ(load(asset, {.scene = 0}).instances.at(0).name, "a");
  EXPECT_TRUE(load(asset, {.scene = 2}).instances.empty());
  EXPECT_THROW((void)load(asset, {.scene = 3}), SceneError);
  asset.json.erase("scene");
  asset.json.erase("scenes");
  EXPECT_EQ(load(asset).instances.size(), 2u) << "without scenes all roots are drawn";
}

TEST(GltfNodes, InvisibleNodesHideEverythingBelowButCameras) {
  GltfAsset asset =
      withNodes({{{"children", {1, 2, 3}}, {"extensions", {{"KHR_node_visibility", {{"visible", false}}}}}},
                 {{"mesh", 0}, {"extensions", {{"KHR_node_visibility", {{"visible", true}}}}}},
                 {{"camera", 0}},
                 {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}},
                 {{"mesh", 0}}},
                {0, 4});
  asset.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}};
  asset.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
  asset.json["extensionsRequired"] = {"KHR_node_visibility", "KHR_lights_punctual"};
  const Scene scene = load(asset);
  EXPECT_EQ(scene.instances.size(), 1u);
  EXPECT_EQ(scene.cameras.size(), 1u);
  EXPECT_TRUE(scene.lights.empty());
}

TEST(GltfNodes, GpuInstancingPlacesTheMeshManyTimes) {
  GltfAsset asset = triangleAsset();
  Json& node = asset.json["nodes"][0];
  node["translation"] = {0, 0, 5};
  const size_t translations = asset.addFloats({1, 0, 0, 0, 2, 0}, "VEC3");
  const size_t rotations = asset.addAccessor<int16_t>({0, 0, 0, 32767, 0, 0, 23170, 23170}, kInt16, "VEC4", true);
  const size_t scales = asset.addFloats({1, 1, 1, 3, 3, 3}, "VEC3");
  node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
      {"TRANSLATION", translations}, {"ROTATION", rotations}, {"SCALE", scales}};
  asset.json["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
  const Scene scene = load(asset);
  ASSERT_EQ(scene.instances.size(), 2u);
  expectNear(transformed(scene.instances[0], {1, 0, 0}), {2, 0, 5}, 1e-4);
  expectNear(transformed(scene.instances[1], {1, 0, 0}), {0, 5, 5}, 1e-4); // 23170 / 32767 is sqrt(1/2) to 2e-5
}

TEST(GltfNodes, TheNumberOfInstancesIsLimited) {
  const Json nodes = {{{"mesh", 0}}, {{"mesh", 0}}, {{"mesh", 0}}};
  EXPECT_THROW((void)load(withNodes(nodes, {0, 1, 2}), {.maxNodes = 2}), LimitError);
  GltfAsset instanced = triangleAsset();
  instanced.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] =
      instanced.addFloats({0, 0, 0, 1, 0, 0, 2, 0, 0}, "VEC3");
  EXPECT_EQ(load(instanced, {.maxNodes = 3}).instances.size(), 3u);
  EXPECT_THROW((void)load(instanced, {.maxNodes = 2}), LimitError);
}

TEST(GltfCameras, PerspectiveIsReadAndPlacedWithoutScale) {
  GltfAsset asset = withNodes({{{"camera", 0},
                                {"name", "node"},
                                {"translation", {1, 2, 3}},
                                {"rotation", {0, kHalf, 0, kHalf}},
                                {"scale", {-2, 3, 4}}},
                               {{"camera", 1}}},
                              {0, 1});
  asset.json["cameras"] = {
      {{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.1}, {"zfar", 50}, {"aspectRatio", 1.5}}}},
      {{"type", "perspective"}, {"name", "endless"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.1}}}}};
  const Scene scene = load(asset);
  ASSERT_EQ(scene.cameras.size(), 2u);
  const Camera& camera = scene.cameras[0];
  EXPECT_EQ(camera.kind, CameraKind::Perspective);
  EXPECT_EQ(camera.name, "node");
  EXPECT_DOUBLE_EQ(camera.yfov, 0.8);
  EXPECT_DOUBLE_EQ(camera.aspectRatio.value_or(0), 1.5);
  EXPECT_DOUBLE_EQ(camera.znear, 0.1);
  EXPECT_DOUBLE_EQ(camera.zfar, 50);
  // A quarter turn about y: -z becomes -x.
  expectNear(glm::dvec3(camera.worldFromCamera * glm::dvec4(0, 0, -1, 0)), {-1, 0, 0});
  expectNear(glm::dvec3(camera.worldFromCamera * glm::dvec4(0, 1, 0, 0)), {0, 1, 0});
  expectNear(glm::dvec3(camera.worldFromCamera[3]), {1, 2, 3});
  EXPECT_NEAR(glm::determinant(camera.worldFromCamera), 1, 1e-12);
  EXPECT_EQ(scene.cameras[1].name, "endless");
  EXPECT_FALSE(scene.cameras[1].aspectRatio.has_value());
  EXPECT_EQ(scene.cameras[1].zfar, 0);
}

TEST(GltfCameras, OrthographicIsRead) {
  GltfAsset asset = withNodes({{{"camera", 0}}});
  asset.json["cameras"] = {
      {{"type", "orthographic"}, {"orthographic", {{"xmag", 3}, {"ymag", -2}, {"znear", 0}, {"zfar", 10}}}}};
  const Scene scene = load(asset);
  const Camera& camera = scene.cameras.at(0);
  EXPECT_EQ(camera.kind, CameraKind::Orthographic);
  EXPECT_EQ(camera.xmag, 3);
  EXPECT_EQ(camera.ymag, 2);
  EXPECT_EQ(camera.zfar, 10);
  EXPECT_TRUE(warns(scene, "negative magnification"));
}

TEST(GltfCameras, ExtrasGiveThemALensOrAPanorama) {
  const auto cameraWith = [](Json extras) {
    GltfAsset asset = withNodes({{{"camera", 0}}});
    asset.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}};
    asset.json["cameras"][0]["extras"] = std::move(extras);
    return load(asset);
  };
  const Camera lens =
      cameraWith({{"lensRadius", 0.02}, {"focusDistance", 3}, {"apertureBlades", 6}, {"apertureRotation", 0.5}})
          .cameras.at(0);
  EXPECT_TRUE(lens.hasLens());
  EXPECT_EQ(lens.lensRadius, 0.02);
  EXPECT_EQ(lens.focusDistance, 3);
  EXPECT_EQ(lens.apertureBlades, 6u);
  EXPECT_EQ(lens.apertureRotation, 0.5);
  const Scene blurred = cameraWith({{"lensRadius", 0.02}}); // at what distance is it sharp?
  EXPECT_FALSE(blurred.cameras.at(0).hasLens());
  EXPECT_TRUE(warns(blurred, "no focusDistance"));
  EXPECT_TRUE(warns(cameraWith({{"lensRadius", -1}}), "below 0"));
  EXPECT_EQ(cameraWith({{"projection", "panorama"}}).cameras.at(0).kind, CameraKind::Panorama);
  for (const Json& foreign : {Json("text"), Json(5), Json({{"projection", 3}, {"lensRadius", "f/2"}}), Json({1, 2})}) {
    const Scene scene = cameraWith(foreign);
    EXPECT_EQ(scene.cameras.at(0).kind, CameraKind::Perspective);
    EXPECT_FALSE(scene.cameras.at(0).hasLens());
    EXPECT_TRUE(scene.warnings.empty());
  }
}

TEST(GltfLights, AreReadAndPlaced) {
  GltfAsset asset = withNodes({{{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}, {"translation", {1, 2, 3}}},
                               {{"extensions", {{"KHR_lights_punctual", {{"light", 1}}}}},
                                {"rotation", {-kHalf, 0, 0, kHalf}},
                                {"scale", {5, 5, 5}}},
                               {{"extensions", {{"KHR_lights_punctual", {{"light", 2}}}}}}},
                              {0, 1, 2});
  asset.json["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "point"}, {"name", "bulb"}, {"color", {1, 0.5, 0}}, {"intensity", 40}, {"range", 7}},
      {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.2}, {"outerConeAngle", 0.6}}}},
      {{"type", "directional"}, {"intensity", 3}}};
  const Scene scene = load(asset);
  ASSERT_EQ(scene.lights.size(), 3u);
  EXPECT_EQ(scene.lights[0].name, "bulb");
  EXPECT_EQ(scene.lights[0].kind, LightKind::Point);
  EXPECT_EQ(scene.lights[0].intensity, glm::vec3(40, 20, 0));
  EXPECT_EQ(scene.lights[0].range, 7);
  expectNear(scene.lights[0].position, {1, 2, 3});
  EXPECT_EQ(scene.lights[1].kind, LightKind::Spot);
  EXPECT_EQ(scene.lights[1].innerConeAngle, 0.2f);
  EXPECT_EQ(scene.lights[1].outerConeAngle, 0.6f);
  expectNear(scene.lights[1].direction, {0, -1, 0}); // -z turned down by a quarter turn about x
  EXPECT_EQ(scene.lights[2].kind, LightKind::Directional);
  EXPECT_EQ(scene.lights[2].intensity, glm::vec3(3));
  EXPECT_EQ(scene.lights[2].range, 0);
  expectNear(scene.lights[2].direction, {0, 0, -1});
}

TEST(GltfLights, ExtrasGiveThemASize) {
  const auto lightWith = [](Json light) {
    GltfAsset asset = withNodes({{{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}, {"scale", {3, 3, 3}}}});
    asset.json["extensions"]["KHR_lights_punctual"]["lights"] = Json::array({std::move(light)});
    return load(asset);
  };
  const auto withRadius = [&](const char* type, Json radius) {
    return lightWith({{"type", type}, {"extras", {{"radius", std::move(radius)}}}});
  };
  EXPECT_EQ(withRadius("point", 0.25).lights.at(0).radius, 0.25f); // the node's scale does not touch it
  EXPECT_TRUE(withRadius("spot", 2).lights.at(0).isSphere());
  EXPECT_TRUE(withRadius("directional", 0.004).lights.at(0).isSun());
  for (const Json& foreign : {Json("wide"), Json(nullptr), Json({1, 2})}) { // another program's extras
    const Scene scene = withRadius("point", foreign);
    EXPECT_EQ(scene.lights.at(0).radius, 0);
    EXPECT_TRUE(scene.warnings.empty());
  }
  EXPECT_EQ(lightWith({{"type", "point"}, {"extras", 7}}).lights.at(0).radius, 0);
  const Scene negative = withRadius("point", -1);
  EXPECT_EQ(negative.lights.at(0).radius, 0);
  EXPECT_EQ(negative.warnings.size(), 1u);
  EXPECT_LE(withRadius("directional", 3).lights.at(0).radius, 1.5707964f);
  const Scene tiny = withRadius("point", 1e-20); // its radiance would leave the range of float
  EXPECT_EQ(tiny.lights.at(0).radius, 0);
  EXPECT_EQ(tiny.warnings.size(), 1u);
}

TEST(GltfLights, ValuesOutOfRangeAreClamped) {
  GltfAsset asset = withNodes({{{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}});
  asset.json["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "spot"},
       {"color", {2, 0, 0}},
       {"intensity", -1},
       {"range", 0},
       {"spot", {{"innerConeAngle", 2}, {"outerConeAngle", 3}}}}};
  const Scene scene = load(asset);
  const PunctualLight& light = scene.lights.at(0);
  EXPECT_EQ(light.intensity, glm::vec3(0));
  EXPECT_LE(light.outerConeAngle, 1.5707964f);
  EXPECT_LT(light.innerConeAngle, light.outerConeAngle);
  EXPECT_EQ(scene.warnings.size(), 5u);
}
