#include "upload/pack_scene.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

#include "accel/wide_bvh.hpp"
#include "isophote/error.hpp"

using namespace isophote;

namespace {

constexpr double kPi = 3.14159265358979323846;

// Two triangles: the unit square in z = 0.
Primitive square(uint32_t material = 0) {
  Primitive primitive;
  primitive.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  primitive.indices = {0, 1, 2, 0, 2, 3};
  primitive.material = material;
  return primitive;
}

Scene sceneOf(std::vector<Primitive> primitives, uint32_t instances = 1) {
  Scene scene;
  scene.materials.resize(1);
  scene.meshes.resize(1);
  scene.meshes[0].primitives = std::move(primitives);
  scene.instances.resize(instances);
  return scene;
}

glm::dmat4 placedAt(glm::dvec3 position, glm::dvec3 scale = glm::dvec3(1)) {
  glm::dmat4 map(1);
  for (int axis = 0; axis < 3; ++axis) map[axis][axis] = scale[axis];
  map[3] = glm::dvec4(position, 1);
  return map;
}

uint32_t addTexture(Scene& scene, uint32_t width, const std::vector<uint8_t>& rgba) {
  ImageData image;
  image.width = width;
  image.height = static_cast<uint32_t>(rgba.size() / 4 / width);
  for (const uint8_t value : rgba) image.pixels.push_back(std::byte{value});
  scene.images.push_back(image);
  Texture texture;
  texture.image = static_cast<uint32_t>(scene.images.size() - 1);
  scene.textures.push_back(texture);
  return static_cast<uint32_t>(scene.textures.size() - 1);
}

// Visits both levels from the root and counts how often each (instance, triangle) is reached.
std::map<std::pair<uint32_t, uint32_t>, uint32_t> reached(const PackedScene& packed) {
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> counts;
  std::vector<std::pair<uint32_t, uint32_t>> work{{0, gpu::kInvalidIndex}}; // node, instance
  while (!work.empty()) {
    const auto [index, instance] = work.back();
    work.pop_back();
    const gpu::BvhNode& node = packed.nodes.at(index);
    const int inner = std::popcount(node.contents >> gpu::kBvhInnerShift);
    const int items = std::popcount(node.contents & ((1u << gpu::kBvhInnerShift) - 1));
    for (int i = 0; i < inner; ++i) work.emplace_back(node.firstChild + i, instance);
    for (uint32_t i = node.firstItem; i < node.firstItem + items; ++i) {
      if (instance == gpu::kInvalidIndex)
        work.emplace_back(packed.instances.at(i).rootNode, i);
      else
        ++counts[{instance, i}];
    }
  }
  return counts;
}

double sumOfPmf(const PackedScene& packed) {
  return std::accumulate(packed.lightAlias.begin(), packed.lightAlias.end(), 0.0,
                         [](double sum, const gpu::AliasEntry& entry) { return sum + entry.pmf; });
}

} // namespace

TEST(PackScene, AnEmptySceneHasEmptyArrays) {
  const PackedScene packed = packScene({});
  EXPECT_TRUE(packed.nodes.empty() && packed.triangles.empty() && packed.instances.empty());
  EXPECT_TRUE(packed.lightAlias.empty() && packed.materials.empty() && !packed.tables.facets);
  EXPECT_EQ(packed.worldRadius, 1);
  EXPECT_EQ(packed.emitterScale, 1);
  EXPECT_EQ(packed.features, FeatureSet());
}

TEST(PackScene, EveryTriangleOfEveryInstanceIsReachedOnceFromTheRoot) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> unit(-1, 1);
  Scene scene = sceneOf({}, 0);
  scene.meshes.resize(5);
  uint32_t triangles = 0;
  for (uint32_t m = 0; m < 5; ++m) {
    for (uint32_t p = 0; p < 3; ++p) {
      Primitive primitive = square();
      for (uint32_t i = 0; i < 40 * m * m; ++i) {
        for (uint32_t k = 0; k < 3; ++k) {
          primitive.indices.push_back(static_cast<uint32_t>(primitive.positions.size()));
          primitive.positions.emplace_back(unit(random), unit(random), unit(random));
        }
      }
      scene.meshes[m].primitives.push_back(primitive);
    }
  }
  for (uint32_t i = 0; i < 40; ++i) {
    scene.instances.push_back({i % 5, placedAt({30 * unit(random), 30 * unit(random), 30 * unit(random)}), {}});
    for (const Primitive& p : scene.meshes[i % 5].primitives) triangles += static_cast<uint32_t>(p.indices.size() / 3);
  }
  const PackedScene packed = packScene(scene);
  const auto counts = reached(packed);
  EXPECT_EQ(counts.size(), triangles);
  EXPECT_EQ(packed.bvh.instancedTriangles, triangles);
  EXPECT_EQ(packed.bvh.triangles, packed.triangles.size());
  EXPECT_EQ(packed.bvh.nodes, packed.nodes.size());
  EXPECT_LE(packed.bvh.maxDepth, 2 * gpu::kMaxBvhDepth);
  for (const auto& [key, count] : counts) {
    ASSERT_EQ(count, 1u);
    // And under an instance only triangles of its mesh: geometries are numbered by mesh, three each.
    ASSERT_EQ(packed.triangles[key.second].geometry / 3, packed.instances[key.first].mesh);
  }
}

TEST(PackScene, TrianglesKeepTheirPlaceInTheScene) {
  Primitive turned = square();
  turned.indices = {3, 1, 0, 2, 3, 1};
  const Scene scene = sceneOf({square(), turned});
  const PackedScene packed = packScene(scene);
  ASSERT_EQ(packed.triangles.size(), 4u);
  for (const gpu::BvhTriangle& triangle : packed.triangles) {
    const Primitive& primitive = scene.meshes[0].primitives[triangle.geometry];
    const uint32_t* corner = &primitive.indices[3 * triangle.primitiveIndex];
    EXPECT_EQ(triangle.v0, primitive.positions[corner[0]]);
    EXPECT_EQ(triangle.v1, primitive.positions[corner[1]]);
    EXPECT_EQ(triangle.v2, primitive.positions[corner[2]]);
    EXPECT_EQ(triangle.flags, 0u);
  }
}

TEST(PackScene, AnUnusedMeshCostsNothing) {
  Scene scene = sceneOf({square()});
  const PackedScene before = packScene(scene);
  Mesh unused;
  unused.primitives = {square(1), square(2)};
  unused.primitives[0].normals.assign(4, {0, 0, 1});
  unused.primitives[1].colors.assign(4, glm::vec4(1));
  scene.meshes.insert(scene.meshes.begin(), unused);
  scene.instances[0].mesh = 1;
  scene.materials.resize(3);
  scene.materials[1].emissive = glm::vec3(1);
  const PackedScene after = packScene(scene);
  EXPECT_EQ(after.triangles.size(), before.triangles.size());
  EXPECT_EQ(after.nodes.size(), before.nodes.size());
  EXPECT_EQ(after.geometries.size(), before.geometries.size());
  EXPECT_EQ(after.materials.size(), 1u);
  EXPECT_TRUE(after.normals.empty() && after.colors.empty() && after.emissiveTriangles.empty());
  EXPECT_EQ(after.features, before.features);
}

TEST(PackScene, AttributesThatNothingReadsAreLeftOut) {
  Primitive plain = square();
  for (auto& uvs : plain.uvs) uvs.assign(4, glm::vec2(0.5f));
  plain.tangents.assign(4, glm::vec4(1, 0, 0, 1));
  const PackedScene without = packScene(sceneOf({plain}));
  EXPECT_TRUE(without.uvs.empty() && without.tangents.empty() && without.indices.empty());
  EXPECT_EQ(without.geometries[0].firstIndex, gpu::kInvalidIndex);

  plain.normals.assign(4, {0, 0, 1});
  Scene scene = sceneOf({plain, plain});
  const auto texture = static_cast<int32_t>(addTexture(scene, 1, {9, 9, 9, 255}));
  scene.materials[0].normalTexture = {.texture = texture, .uvSet = 2};
  const PackedScene with = packScene(scene);
  EXPECT_EQ(with.uvs.size(), 8u);
  EXPECT_EQ(with.tangents.size(), 8u);
  EXPECT_EQ(with.indices.size(), 12u);
  EXPECT_EQ(with.geometries[1].firstUv[0], gpu::kInvalidIndex);
  EXPECT_EQ(with.geometries[1].firstUv[2], 4u);
  EXPECT_EQ(with.geometries[1].firstNormal, 4u);
  EXPECT_EQ(with.geometries[1].firstIndex, 6u);
}

TEST(PackScene, TexturesAreListedOncePerUse) {
  Scene scene = sceneOf({square()});
  addTexture(scene, 1, {1, 1, 1, 255}); // never referenced
  const auto used = static_cast<int32_t>(addTexture(scene, 1, {9, 9, 9, 255}));
  scene.materials[0].baseColorTexture = {.texture = used};
  scene.materials[0].emissiveTexture = {.texture = used}; // does not emit: not read
  scene.materials[0].metallicRoughnessTexture = {.texture = used};
  scene.materials[0].specularTexture = {.texture = used};
  const PackedScene packed = packScene(scene);
  ASSERT_EQ(packed.textures.size(), 2u); // as color and as data
  EXPECT_NE(packed.textures[0].srgb, packed.textures[1].srgb);
  EXPECT_EQ(packed.textures[0].image, 1u);
  EXPECT_EQ(packed.textureSlots.size(), 3u);
  EXPECT_EQ(packed.materials[0].emissiveSlot, gpu::kInvalidIndex);
  EXPECT_TRUE(packed.textures[packed.textureSlots[packed.materials[0].baseColorSlot].texture].srgb);
  EXPECT_FALSE(packed.textures[packed.textureSlots[packed.materials[0].specularSlot].texture].srgb);
}

TEST(PackScene, InstanceMapsInvertEachOtherAndKnowMirrors) {
  Scene scene = sceneOf({square()}, 2);
  scene.instances[0].worldFromObject = placedAt({1, 2, 3}, {2, 3, 4});
  scene.instances[1].worldFromObject = placedAt({-1, -2, -3}, {2, -3, 4});
  for (const gpu::InstanceRecord& record : packScene(scene).instances) {
    for (int row = 0; row < 3; ++row) {
      EXPECT_FLOAT_EQ(record.worldFromObject[row][row] * record.objectFromWorld[row][row], 1);
      EXPECT_FLOAT_EQ(record.objectFromWorld[row].w, -record.worldFromObject[row].w / record.worldFromObject[row][row]);
    }
    EXPECT_EQ(record.flags, record.worldFromObject[1][1] < 0 ? gpu::kInstanceMirrored : 0u);
  }
}

TEST(PackScene, InstanceBoxesHoldTheirTriangles) {
  Scene scene = sceneOf({square()}, 50);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (Instance& instance : scene.instances) {
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) instance.worldFromObject[i][k] = unit(random);
    }
    instance.worldFromObject[3] = glm::dvec4(1e3 * unit(random), 1e3 * unit(random), 1e3 * unit(random), 1);
  }
  const PackedScene packed = packScene(scene);
  uint32_t boxes = 0;
  for (const gpu::BvhNode& node : packed.nodes) {
    if (node.origin.z == 0) continue; // the mesh's own: the square lies in z = 0
    uint32_t item = node.firstItem;
    for (uint32_t slot = 0; slot < gpu::kBvhWidth; ++slot) {
      if ((node.contents >> gpu::kBvhItemsPerSlot * slot & 1u) == 0) continue;
      const gpu::InstanceRecord& instance = packed.instances.at(item++);
      const Box box = childBox(node, slot);
      ++boxes;
      for (const glm::vec3& v : scene.meshes[0].primitives[0].positions) {
        for (int row = 0; row < 3; ++row) {
          const double world = glm::dot(glm::dvec4(instance.worldFromObject[row]), glm::dvec4(v, 1));
          EXPECT_GE(world, box.lower[row]);
          EXPECT_LE(world, box.upper[row]);
        }
      }
    }
  }
  EXPECT_EQ(boxes, 50u);
}

TEST(PackScene, LightBoundsFollowTheirInstances) {
  Scene scene = sceneOf({square()}, 40);
  scene.materials[0].emissive = glm::vec3(1);
  for (uint32_t i = 0; i < 40; ++i) scene.instances[i].worldFromObject = placedAt({3.0 * i, 7, -5});
  const PackedScene packed = packScene(scene);
  ASSERT_FALSE(packed.lightTree.empty());
  const gpu::LightTreeNode& root = packed.lightTree[0];
  const glm::dvec3 center = glm::dvec3(root.center) / static_cast<double>(packed.lightTreeScale) + packed.worldOrigin;
  EXPECT_NEAR(center.x, 59, 0.01); // squares of size 1 from x = 0 to 117
  EXPECT_NEAR(center.y, 7.5, 0.01);
  EXPECT_NEAR(center.z, -5, 0.01);
  EXPECT_NEAR(root.extent.x / packed.lightTreeScale, 59, 0.01);
}

TEST(PackScene, WorldOriginMovesOnlyWhereTheSceneIsFarAway) {
  Scene scene = sceneOf({square()});
  const double radius = std::sqrt(0.5);
  scene.instances[0].worldFromObject = placedAt({15 * radius, 0, 0});
  EXPECT_EQ(packScene(scene).worldOrigin, glm::dvec3(0));
  EXPECT_NEAR(packScene(scene).worldRadius, radius, 1e-12);

  scene.instances[0].worldFromObject = placedAt({1e7, 1, -2e7});
  const PackedScene far = packScene(scene);
  EXPECT_NEAR(glm::length(far.worldOrigin - glm::dvec3(1e7 + 0.5, 1.5, -2e7)), 0, 1e-7);
  EXPECT_EQ(far.instances[0].worldFromObject[0].w, -0.5f);
  EXPECT_EQ(far.worldCenter, far.worldOrigin);
}

TEST(PackScene, OnlyTrianglesThatCanBeSeenThroughAreTested) {
  const auto flags = [](const Scene& scene) { return packScene(scene).triangles[0].flags; };
  Scene scene = sceneOf({square()});
  EXPECT_EQ(flags(scene), 0u);
  for (const AlphaMode mode : {AlphaMode::Mask, AlphaMode::Blend}) {
    scene = sceneOf({square()});
    scene.materials[0].alphaMode = mode;
    EXPECT_EQ(flags(scene), 0u);
    EXPECT_FALSE(packScene(scene).features.has(Feature::kHasAlpha));
    scene.materials[0].baseColor.a = 0.9f;
    EXPECT_EQ(flags(scene), gpu::kTriangleHasAlpha);
    EXPECT_TRUE(packScene(scene).features.has(Feature::kHasAlpha));
    scene.materials[0].baseColor.a = 1;
    scene.meshes[0].primitives[0].colors = {glm::vec4(1), glm::vec4(1), glm::vec4(1), {1, 1, 1, 0.5f}};
    EXPECT_EQ(flags(scene), gpu::kTriangleHasAlpha);
    scene.meshes[0].primitives[0].colors[3].a = 1;
    EXPECT_EQ(flags(scene), 0u);
    scene.materials[0].baseColorTexture.texture =
        static_cast<int32_t>(addTexture(scene, 2, {0, 0, 0, 255, 0, 0, 0, 255}));
    EXPECT_EQ(flags(scene), 0u);
    scene.images[0].pixels[7] = std::byte{254};
    EXPECT_EQ(flags(scene), gpu::kTriangleHasAlpha);
  }
  scene.materials[0].alphaMode = AlphaMode::Opaque;
  EXPECT_EQ(flags(scene), 0u);
}

TEST(PackScene, GgxTableComesWithSpecularMaterialsOnly) {
  Scene scene = sceneOf({square()});
  EXPECT_TRUE(packScene(scene).tables.facets);
  scene.materials[0].metallic = scene.materials[0].specular = 0;
  EXPECT_FALSE(packScene(scene).tables.facets);
}

TEST(PackScene, LightIndicesFindTheirTriangles) {
  // Instances 3 x (4 emissive of 8 triangles), a point light, an environment.
  Scene scene = sceneOf({square(0), square(1), square(0), square(2)}, 3);
  scene.materials.resize(3);
  scene.materials[1].emissive = {1, 2, 3};
  scene.materials[2].emissive = {4, 0, 0};
  for (int i = 0; i < 3; ++i) scene.instances[static_cast<size_t>(i)].worldFromObject = placedAt({3.0 * i, 0, 0});
  scene.lights.emplace_back();
  scene.environment = Environment{.width = 1, .height = 1, .pixels = {glm::vec3(1)}};
  const PackedScene packed = packScene(scene);
  ASSERT_EQ(packed.emissiveTriangles.size(), 12u);
  ASSERT_EQ(packed.lightAlias.size(), 14u);
  for (uint32_t instance = 0; instance < 3; ++instance) {
    for (uint32_t t = 0; t < packed.triangles.size(); ++t) {
      const gpu::BvhTriangle& triangle = packed.triangles[t];
      const gpu::Geometry& geometry = packed.geometries[triangle.geometry];
      EXPECT_EQ(triangle.flags, packed.materials[geometry.material].emissive.x > 0 ? gpu::kTriangleEmissive : 0);
      if (geometry.firstEmissive == gpu::kInvalidIndex) {
        EXPECT_EQ(triangle.flags, 0u);
        continue;
      }
      const uint32_t light = packed.instances[instance].firstEmitter + geometry.firstEmissive + triangle.primitiveIndex;
      EXPECT_EQ(packed.emissiveTriangles.at(light).instance, instance);
      EXPECT_EQ(packed.emissiveTriangles.at(light).triangle, t);
    }
  }
  EXPECT_NEAR(sumOfPmf(packed), 1, 1e-6);
}

// The tree chooses by where lights are, so it must know where their instances stand.
TEST(PackScene, TheLightTreeHoldsLightsWhereTheirInstancesStand) {
  Scene scene = sceneOf({square()}, 10);
  scene.materials[0].emissive = glm::vec3(1);
  for (size_t i = 0; i < scene.instances.size(); ++i)
    scene.instances[i].worldFromObject = placedAt({7.0 * static_cast<double>(i), 3, i % 2 == 0 ? -5 : 5});
  const PackedScene packed = packScene(scene);
  ASSERT_FALSE(packed.lightTree.empty());
  const auto expectBox = [&](const gpu::LightTreeNode& node, glm::dvec3 lower, glm::dvec3 upper) {
    const glm::dvec3 center = glm::dvec3(node.center) / double{packed.lightTreeScale} + packed.worldOrigin;
    const glm::dvec3 extent = glm::dvec3(node.extent) / double{packed.lightTreeScale};
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(center[axis] - extent[axis], lower[axis], 1e-3) << axis;
      EXPECT_NEAR(center[axis] + extent[axis], upper[axis], 1e-3) << axis;
    }
  };
  expectBox(packed.lightTree[0], {0, 3, -5}, {64, 4, 5});
  const glm::vec4(&rows)[3] = packed.instances.back().worldFromObject;
  const glm::dvec3 corner = glm::dvec3(rows[0].w, rows[1].w, rows[2].w) + packed.worldOrigin;
  uint32_t child = packed.lightTree[0].child; // the way to the last light, the second triangle of the last instance
  for (uint32_t trail = packed.lightTrails.back(); (child & gpu::kLightTreeLeaf) == 0; trail >>= 1) {
    const uint32_t node = (child & gpu::kLightTreeIndexMask) + (trail & 1u);
    child = packed.lightTree[node].child;
    if ((child & gpu::kLightTreeLeaf) != 0) expectBox(packed.lightTree[node], corner, corner + glm::dvec3(1, 1, 0));
  }
}

TEST(PackScene, LightsAreChosenByTheirPower) {
  Scene scene = sceneOf({square(0), square(1)}, 2);
  scene.materials.resize(2);
  scene.materials[0].emissive = glm::vec3(2);
  scene.materials[1].emissive = glm::vec3(1);
  scene.materials[1].doubleSided = true;
  scene.instances[1].worldFromObject = placedAt({5, 0, 0}, {3, 2, 1});
  PunctualLight light;
  light.intensity = glm::vec3(7);
  scene.lights.push_back(light);
  light.kind = LightKind::Directional;
  scene.lights.push_back(light);
  light.kind = LightKind::Spot;
  light.innerConeAngle = 0.3f;
  light.outerConeAngle = 0.9f;
  scene.lights.push_back(light);
  light.intensity = glm::vec3(0);
  scene.lights.push_back(light);
  scene.environment =
      Environment{.width = 4, .height = 2, .pixels = std::vector<glm::vec3>(8, glm::vec3(0.5f)), .intensity = 3};
  const PackedScene packed = packScene(scene);

  const double disk = kPi * packed.worldRadius * packed.worldRadius;
  std::vector<double> expected;
  for (const gpu::InstanceRecord& instance : packed.instances) {
    const double area = 0.5 * instance.worldFromObject[0].x * instance.worldFromObject[1].y;
    // Luminance 2 on one side, then 1 on both.
    for (int i = 0; i < 4; ++i) expected.push_back(kPi * area * 2);
  }
  // Falloff clamp((cos - cosOuter) / (cosInner - cosOuter))^2 integrated numerically.
  double cone = 0;
  for (int i = 0; i < 100000; ++i) {
    const double c = -1 + 2 * (i + 0.5) / 100000;
    const double falloff = std::clamp((c - std::cos(0.9)) / (std::cos(0.3) - std::cos(0.9)), 0.0, 1.0);
    cone += 2 * kPi * falloff * falloff * 2 / 100000;
  }
  expected.insert(expected.end(), {4 * kPi * 7, disk * 7, cone * 7, 0, disk * 4 * kPi * 1.5});
  const double sum = std::accumulate(expected.begin(), expected.end(), 0.0);
  ASSERT_EQ(packed.lightAlias.size(), expected.size());
  for (size_t i = 0; i < expected.size(); ++i)
    EXPECT_NEAR(packed.lightAlias[i].pmf, expected[i] / sum, 1e-4 * expected[i] / sum) << i;
  EXPECT_EQ(packed.lightAlias[11].pmf, 0);
}

TEST(PackScene, TexturedEmissionIsAveragedAndNeverRuledOut) {
  // Left half black, right half white: a triangle on each, and one across.
  Primitive primitive = square();
  primitive.positions.emplace_back(2, 0, 0);
  primitive.indices = {0, 1, 3, 0, 1, 3, 0, 1, 3};
  primitive.positions = {{0, 0, 0}, {1, 0, 0}, {0, 0, 0}, {0, 1, 0}};
  Scene scene = sceneOf({});
  const auto texture = static_cast<int32_t>(addTexture(scene, 2, {0, 0, 0, 255, 255, 255, 255, 255}));
  for (const float u : {0.01f, 0.51f, 0.25f}) {
    Primitive part = primitive;
    part.indices = {0, 1, 3};
    const float width = u == 0.25f ? 0.5f : 0.48f;
    part.uvs[0] = {{u, 0.1f}, {u + width, 0.1f}, {u, 0.1f}, {u, 0.9f}};
    scene.meshes[0].primitives.push_back(part);
  }
  scene.materials[0].emissive = glm::vec3(10);
  scene.materials[0].emissiveTexture.texture = texture;
  const PackedScene packed = packScene(scene);
  ASSERT_EQ(packed.lightAlias.size(), 3u);
  // Means: 1% floor, 1, and a quarter of the triangle's area (u > 1/2).
  const double sum = 0.01 + 1 + 0.25;
  EXPECT_NEAR(packed.lightAlias[0].pmf, 0.01 / sum, 1e-6);
  EXPECT_NEAR(packed.lightAlias[1].pmf, 1 / sum, 0.02);
  EXPECT_NEAR(packed.lightAlias[2].pmf, 0.25 / sum, 0.03);
  EXPECT_EQ(packed.emitterScale, 16);

  scene.images[0].pixels.assign(8, std::byte{0});
  EXPECT_TRUE(packScene(scene).lightAlias.empty());
}

TEST(PackScene, UnlitMaterialsAreNoLights) {
  Scene scene = sceneOf({square()});
  scene.materials[0].emissive = glm::vec3(100);
  scene.materials[0].unlit = true;
  const PackedScene packed = packScene(scene);
  EXPECT_TRUE(packed.emissiveTriangles.empty());
  EXPECT_FALSE(packed.features.has(Feature::kHasEmissiveTriangles));
  EXPECT_EQ(packed.materials[0].emissive, glm::vec3(0));
  EXPECT_EQ(packed.emitterScale, 1);
}

TEST(PackScene, ABlackEnvironmentIsNone) {
  Scene scene = sceneOf({square()});
  scene.environment = Environment{.width = 2, .height = 1, .pixels = std::vector<glm::vec3>(2, glm::vec3(0))};
  const PackedScene packed = packScene(scene);
  EXPECT_TRUE(packed.environmentPixels.empty() && packed.environmentMarginal.empty() && packed.lightAlias.empty());
  EXPECT_FALSE(packed.features.has(Feature::kHasEnvironment));
}

TEST(PackScene, EmitterScaleIsThePowerOfTwoAboveTheBrightest) {
  Scene scene = sceneOf({square()});
  for (const auto& [radiance, scale] : {std::pair{1.0f, 1.0f}, {1.1f, 2.0f}, {100.0f, 128.0f}, {3e-5f, 0x1p-15f}}) {
    scene.materials[0].emissive = {0, radiance, radiance / 2};
    EXPECT_EQ(packScene(scene).emitterScale, scale);
  }
  scene.environment =
      Environment{.width = 2, .height = 1, .pixels = {glm::vec3(1), glm::vec3(1, 5, 1)}, .intensity = 100};
  EXPECT_EQ(packScene(scene).emitterScale, 512);
  EXPECT_EQ(packScene(scene).environmentPixels[1], glm::vec3(100, 500, 100));
}

// One sample of one lamp stands for the light of all: the film must have room for that, and for floors near a lamp.
TEST(PackScene, EmitterScaleFollowsTheLightOfAllLampsTogether) {
  Scene scene = sceneOf({square()});
  scene.lights.assign(3, {.kind = LightKind::Directional, .intensity = glm::vec3(1)});
  EXPECT_EQ(packScene(scene).emitterScale, 4);
  scene.lights.resize(1);
  scene.lights[0].kind = LightKind::Point;
  const float one = packScene(scene).emitterScale;
  scene.lights.resize(1024, scene.lights[0]);
  EXPECT_EQ(packScene(scene).emitterScale, 1024 * one);
}

TEST(PackScene, InstancesWithoutTrianglesAreLeftOut) {
  Scene scene = sceneOf({square()}, 2);
  scene.meshes.resize(2);
  scene.instances[0].mesh = 1;
  const PackedScene packed = packScene(scene);
  EXPECT_EQ(packed.instances.size(), 1u);
  scene.instances.resize(1);
  EXPECT_TRUE(packScene(scene).nodes.empty());
}
