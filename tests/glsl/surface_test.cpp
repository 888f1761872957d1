#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "glsl/surface_case.h"
#include "glsl/traversal_scene.hpp"
#include "shared/geometry_types.h"
#include "support/gpu_device.hpp"
#include "test_glsl_kernels.hpp"
#include "upload/pack_scene.hpp"

using namespace isophote;
using gpu::SurfaceCase;
using gpu::SurfaceResult;

namespace {

constexpr uint32_t kTriangles = 200;

// Everything a vertex can carry, at random, in two primitives.
Primitive randomPrimitive(std::mt19937& random, uint32_t material) {
  std::uniform_real_distribution<float> unit(-1, 1);
  Primitive primitive =
      test::meshOf(test::triangleSoup(kTriangles, 0.5f, static_cast<uint32_t>(random())), {}, material).primitives[0];
  for (size_t i = 0; i < primitive.positions.size(); ++i) {
    primitive.normals.push_back(test::randomDirection(random));
    primitive.tangents.emplace_back(test::randomDirection(random), (i / 3) % 2 == 0 ? 1.0f : -1.0f);
    primitive.colors.emplace_back(unit(random), unit(random), unit(random), unit(random));
    primitive.uvs[0].emplace_back(unit(random), unit(random));
    primitive.uvs[1].emplace_back(unit(random), unit(random));
  }
  return primitive;
}

Scene randomScene(uint32_t instances, uint32_t seed) {
  std::mt19937 random(seed);
  Scene scene = test::sceneOf({});
  ImageData image;
  image.width = image.height = 1;
  image.pixels.assign(4, std::byte{255});
  scene.images.push_back(image);
  scene.textures.emplace_back();
  scene.materials.resize(2, scene.materials[0]);
  for (Material& material : scene.materials) {
    material.normalTexture.texture = 0;
    material.baseColorTexture = {.texture = 0, .uvSet = 1};
  }
  scene.meshes.resize(1);
  scene.meshes[0].primitives = {randomPrimitive(random, 0), randomPrimitive(random, 1)};
  for (uint32_t i = 0; i < instances; ++i) {
    Instance instance;
    instance.worldFromObject = test::randomPlacement(random, 10);
    scene.instances.push_back(instance);
  }
  return scene;
}

struct Reference {
  glm::dvec3 p, ng, ns, tangent;
  double area = 0, w = 1;
  glm::dvec4 color{0};
  glm::dvec2 uv0{0}, uv1{0};
};

template <class T, class V> T interpolate(const V& values, const uint32_t* corner, glm::dvec3 weights) {
  return weights.x * T(values[corner[0]]) + weights.y * T(values[corner[1]]) + weights.z * T(values[corner[2]]);
}

// From the glTF specification: edges placed in the world, the winding turned where the determinant is negative.
Reference reference(const Primitive& primitive, uint32_t triangle, const glm::dmat4& placement, glm::dvec2 b) {
  const glm::dvec3 weights(1 - b.x - b.y, b.x, b.y);
  const uint32_t* corner = &primitive.indices[3 * triangle];
  glm::dvec3 v[3];
  for (int k = 0; k < 3; ++k) v[k] = glm::dvec3(placement * glm::dvec4(primitive.positions[corner[k]], 1));
  const glm::dmat3 linear(placement);
  const double sign = glm::determinant(linear) < 0 ? -1 : 1;
  const glm::dvec3 cross = glm::cross(v[1] - v[0], v[2] - v[0]);
  Reference r;
  r.p = weights.x * v[0] + weights.y * v[1] + weights.z * v[2];
  r.area = 0.5 * glm::length(cross);
  r.ng = sign * glm::normalize(cross);
  const glm::dvec3 normal = interpolate<glm::dvec3>(primitive.normals, corner, weights);
  r.ns = glm::normalize(glm::transpose(glm::inverse(linear)) * normal);
  if (glm::dot(r.ns, r.ng) < 0) r.ns = -r.ns;
  r.tangent = linear * glm::dvec3(interpolate<glm::dvec4>(primitive.tangents, corner, weights));
  r.w = sign * primitive.tangents[corner[0]].w;
  r.color = interpolate<glm::dvec4>(primitive.colors, corner, weights);
  r.uv0 = interpolate<glm::dvec2>(primitive.uvs[0], corner, weights);
  r.uv1 = interpolate<glm::dvec2>(primitive.uvs[1], corner, weights);
  return r;
}

// Instances are packed in another order than the scene's: finds the one with this placement.
const glm::dmat4& placementOf(const Scene& scene, const gpu::InstanceRecord& record) {
  const auto found = std::find_if(scene.instances.begin(), scene.instances.end(), [&](const Instance& instance) {
    const glm::vec3 translation(instance.worldFromObject[3]);
    return translation ==
           glm::vec3(record.worldFromObject[0].w, record.worldFromObject[1].w, record.worldFromObject[2].w);
  });
  return found->worldFromObject;
}

std::vector<SurfaceResult> surfaces(const Scene& scene, const std::vector<SurfaceCase>& cases) {
  return test::runOnScene<SurfaceResult>(test_glsl_kernels::kernelSource("surface_probe"),
                                         GpuScene(test::gpuDevice(), scene), cases);
}

std::vector<SurfaceCase> randomCases(const PackedScene& packed, uint32_t count, uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> share(0, 1);
  std::vector<SurfaceCase> cases;
  for (uint32_t i = 0; i < count; ++i) {
    const float b1 = share(random), b2 = (1 - b1) * share(random);
    cases.push_back({static_cast<uint32_t>(random() % packed.instances.size()),
                     static_cast<uint32_t>(random() % packed.triangles.size()),
                     {b1, b2},
                     test::randomDirection(random)});
  }
  return cases;
}

} // namespace

TEST(Surface, EqualsTheDoubleReferenceForAnyPlacement) {
  const Scene scene = randomScene(30, 1);
  const PackedScene packed = packScene(scene);
  const std::vector<SurfaceCase> cases = randomCases(packed, 20000, 2);
  const std::vector<SurfaceResult> results = surfaces(scene, cases);
  uint32_t mirrored = 0;
  for (size_t i = 0; i < cases.size(); ++i) {
    const SurfaceResult& s = results[i];
    const glm::dmat4& placement = placementOf(scene, packed.instances[cases[i].instance]);
    const gpu::BvhTriangle& triangle = packed.triangles[cases[i].triangle];
    const Primitive& primitive = scene.meshes[0].primitives[triangle.geometry];
    const Reference r = reference(primitive, triangle.primitiveIndex, placement, cases[i].barycentrics);
    mirrored += packed.instances[cases[i].instance].flags & gpu::kInstanceMirrored;

    for (int axis = 0; axis < 3; ++axis) ASSERT_LE(std::abs(s.p[axis] - r.p[axis]), s.pError[axis]);
    ASSERT_LT(glm::length(glm::dvec3(s.pError)), 1e-4); // coordinates up to 20, stretched up to 1 : 16
    // Soup triangles may be thin: their normal is as good as their least height over the size of coordinates.
    const double thin = 1e-6 * (1 + 0.25 / r.area);
    ASSERT_LT(glm::length(glm::dvec3(s.ng) - r.ng), 10 * thin);
    ASSERT_NEAR(s.area, r.area, 10 * thin * r.area);
    ASSERT_LT(std::min(glm::length(glm::dvec3(s.ns) - r.ns), glm::length(glm::dvec3(s.ns) + r.ns)), 1e-3);
    if (std::abs(glm::dot(r.ns, r.ng)) > 1e-3) {
      ASSERT_GT(glm::dot(glm::dvec3(s.ns), r.ns), 0.999);
    }
    ASSERT_LT(glm::length(glm::dvec3(s.tangent) - r.tangent), 1e-5);
    ASSERT_EQ(s.tangent.w, r.w);
    ASSERT_LT(glm::length(glm::dvec4(s.color) - r.color), 1e-6);
    ASSERT_LT(glm::length(glm::dvec2(s.uv1) - r.uv1), 1e-6);
    ASSERT_LT(glm::length(glm::dvec2(s.uv0) - r.uv0), 1e-6);
    ASSERT_EQ(s.geometry, triangle.geometry);
    ASSERT_EQ(s.material, triangle.geometry);
    ASSERT_EQ(s.primitiveIndex, triangle.primitiveIndex);
  }
  EXPECT_GT(mirrored, 1000u);
}

TEST(Surface, TurnsToTheSideItIsSeenFrom) {
  const Scene scene = randomScene(5, 3);
  const std::vector<SurfaceCase> cases = randomCases(packScene(scene), 5000, 4);
  const std::vector<SurfaceResult> results = surfaces(scene, cases);
  uint32_t fronts = 0;
  for (size_t i = 0; i < cases.size(); ++i) {
    const SurfaceResult& s = results[i];
    ASSERT_GE(glm::dot(s.ngSeen, cases[i].wo), 0);
    ASSERT_EQ(s.ngSeen, s.frontFace ? s.ng : -s.ng);
    ASSERT_EQ(s.nsSeen, s.frontFace ? s.ns : -s.ns);
    ASSERT_GE(glm::dot(s.ngSeen, s.nsSeen), 0);
    fronts += s.frontFace;
  }
  EXPECT_NEAR(fronts, 2500, 300);
}

TEST(Surface, WithoutNormalsTheShadingNormalIsTheGeometricOne) {
  Scene scene = test::sceneOf({test::meshOf({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})});
  const auto results = surfaces(scene, {{0, 0, {0.2f, 0.3f}, {0, 0, 1}}});
  EXPECT_EQ(results[0].ng, glm::vec3(0, 0, 1));
  EXPECT_EQ(results[0].ns, glm::vec3(0, 0, 1));
  EXPECT_EQ(results[0].area, 0.5f);
  EXPECT_EQ(results[0].p, glm::vec3(0.2f, 0.3f, 0));
}

TEST(Surface, OpposedNormalsThatCancelFallBackToTheGeometricNormal) {
  Scene scene = test::sceneOf({test::meshOf({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})});
  scene.meshes[0].primitives[0].normals = {{0, 0, 0}, {1, 0, 0}, {-1, 0, 0}};
  const auto results = surfaces(scene, {{0, 0, {0.25f, 0.25f}, {0, 0, 1}}});
  EXPECT_EQ(results[0].ns, glm::vec3(0, 0, 1));
}

TEST(Surface, NeedlesOfAnySizeHaveTheirNormalAndArea) {
  for (const double size : {1e-10, 1e-3, 1.0, 1e8}) {
    // 1e-6 as wide as long, turned so that no coordinate is 0.
    std::mt19937 random(5);
    std::vector<glm::vec3> positions;
    const glm::dmat3 turn = glm::dmat3(test::randomPlacement(random, 0));
    for (const glm::dvec3& v : {glm::dvec3(0), glm::dvec3(1, 0, 0), glm::dvec3(1, 1e-6, 0)})
      positions.push_back(glm::vec3(size * (turn * v)));
    const glm::dvec3 e1 = glm::dvec3(positions[1]) - glm::dvec3(positions[0]);
    const glm::dvec3 e2 = glm::dvec3(positions[2]) - glm::dvec3(positions[1]);
    const glm::dvec3 cross = glm::cross(e1, e2);
    const auto results = surfaces(test::sceneOf({test::meshOf(positions)}), {{0, 0, {0.3f, 0.3f}, {0, 0, 1}}});
    EXPECT_LT(glm::length(glm::dvec3(results[0].ng) - glm::normalize(cross)), 1e-6) << size;
    EXPECT_NEAR(results[0].area, 0.5 * glm::length(cross), 1e-6 * 0.5 * glm::length(cross)) << size;
  }
}

TEST(Surface, ObtuseSliversHaveTheirNormalAndArea) {
  // Angles of 1e-4 at both ends of the longest edge; coordinates within a factor of 2, so that edges are exact floats.
  std::mt19937 random(6);
  for (uint32_t i = 0; i < 20; ++i) {
    const glm::dmat3 turn = glm::dmat3(test::randomPlacement(random, 0));
    std::vector<glm::vec3> positions;
    for (const glm::dvec3& v : {glm::dvec3(0), glm::dvec3(1, 1e-4, 0), glm::dvec3(2, 0, 0)})
      positions.push_back(glm::vec3(glm::dvec3(30) + turn * v));
    const glm::dvec3 cross = glm::cross(glm::dvec3(positions[1]) - glm::dvec3(positions[0]),
                                        glm::dvec3(positions[2]) - glm::dvec3(positions[0]));
    const auto results = surfaces(test::sceneOf({test::meshOf(positions)}), {{0, 0, {0.3f, 0.3f}, {0, 0, 1}}});
    ASSERT_LT(glm::length(glm::dvec3(results[0].ng) - glm::normalize(cross)), 1e-6);
  }
}
