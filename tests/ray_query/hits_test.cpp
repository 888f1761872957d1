// The same rays through the project's BVH and through the device's acceleration structures.
#include <algorithm>
#include <cmath>
#include <random>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "glsl/traversal_scene.hpp"
#include "ray_query/ray_query_device.hpp"
#include "render/ray_batch.hpp"
#include "support/scenes.hpp"
#include "upload/pack_scene.hpp"

using namespace isophote;

namespace {

constexpr float kUnbounded = 3.402823466e38f;

/// What rays meet of a scene, by one backend.
struct Traced {
  PackedScene packed; ///< as GpuScene packs it, so with the same numbers
  std::vector<gpu::HitState> hits;
  std::vector<bool> occluded;

  Traced(const Device& device, const Scene& scene, const std::vector<Ray>& rays, Backend backend)
      : packed(packScene(scene, backend)) {
    const GpuScene onDevice(device, scene, backend);
    RayBatch closest(device, onDevice, {RayQuestion::ClosestHit, rays});
    closest.reset();
    closest.trace();
    hits = closest.hits();
    RayBatch any(device, onDevice, {RayQuestion::Occluded, rays});
    any.reset();
    any.trace();
    occluded = any.met();
  }

  [[nodiscard]] bool met(size_t ray) const { return hits[ray].instance != gpu::kInvalidIndex; }
  [[nodiscard]] bool isSphere(size_t ray) const { return hits[ray].triangle == gpu::kInvalidIndex; }
  [[nodiscard]] const gpu::InstanceRecord& instance(size_t ray) const { return packed.instances[hits[ray].instance]; }
  [[nodiscard]] const gpu::BvhTriangle& triangle(size_t ray) const { return packed.triangles[hits[ray].triangle]; }

  /// In world space, relative to the scene's origin. Of triangles.
  [[nodiscard]] glm::dvec3 point(size_t ray) const {
    const gpu::BvhTriangle& face = triangle(ray);
    const glm::dvec2 b(hits[ray].barycentrics);
    const glm::dvec3 object =
        (1 - b.x - b.y) * glm::dvec3(face.v0) + b.x * glm::dvec3(face.v1) + b.y * glm::dvec3(face.v2);
    glm::dvec3 world;
    for (int row = 0; row < 3; ++row)
      world[row] = glm::dot(glm::dvec4(instance(ray).worldFromObject[row]), glm::dvec4(object, 1));
    return world;
  }
};

/// Triangles are stored, and instances numbered, in another order by each backend.
bool sameSurface(const Traced& a, const Traced& b, size_t ray) {
  if (a.isSphere(ray) != b.isSphere(ray)) return false;
  if (!std::equal(std::begin(a.instance(ray).worldFromObject), std::end(a.instance(ray).worldFromObject),
                  std::begin(b.instance(ray).worldFromObject)))
    return false;
  return a.isSphere(ray) || (a.triangle(ray).geometry == b.triangle(ray).geometry &&
                             a.triangle(ray).primitiveIndex == b.triangle(ray).primitiveIndex);
}

struct Agreement {
  uint32_t hits = 0;         ///< by the own BVH
  uint32_t sameBits = 0;     ///< of those: same triangle, same barycentrics
  uint32_t sameTriangle = 0; ///< same triangle, other barycentrics
  uint32_t ties = 0;         ///< another triangle at the same point within rounding
  uint32_t elsewhere = 0;    ///< another point
  uint32_t missed = 0;       ///< met by one of the two only
  uint32_t shadows = 0;      ///< rays that are occluded for one of the two only
};

std::ostream& operator<<(std::ostream& out, const Agreement& a) {
  return out << a.hits << " hits: " << a.sameBits << " the same, " << a.sameTriangle << " with other barycentrics, "
             << a.ties << " ties, " << a.elsewhere << " elsewhere, " << a.missed << " met by one only; " << a.shadows
             << " occluded for one only";
}

/// @param reach  largest coordinate that a hit is computed from: rounding is some 2^-20 of it
Agreement compare(const Device& device, const Scene& scene, const std::vector<Ray>& rays, double reach) {
  const Traced own(device, scene, rays, Backend::Compute);
  const Traced query(device, scene, rays, Backend::RayQuery);
  Agreement result;
  for (size_t i = 0; i < rays.size(); ++i) {
    result.hits += own.met(i);
    result.shadows += own.occluded[i] != query.occluded[i];
    if (own.met(i) != query.met(i)) {
      ++result.missed;
    } else if (own.met(i) && sameSurface(own, query, i)) {
      ++(own.hits[i].barycentrics == query.hits[i].barycentrics ? result.sameBits : result.sameTriangle);
    } else if (own.met(i)) {
      const bool near =
          !own.isSphere(i) && !query.isSphere(i) && glm::distance(own.point(i), query.point(i)) <= 1e-6 * reach;
      ++(near ? result.ties : result.elsewhere);
    }
  }
  testing::Test::RecordProperty("agreement", testing::PrintToString(result));
  return result;
}

/// Random rays rarely pass within rounding of an edge or of a silhouette: one in a thousand may.
void expectAgreement(const Agreement& agreement, size_t rays) {
  const auto few = static_cast<uint32_t>(rays / 1000);
  EXPECT_GT(agreement.hits, rays / 20) << agreement;
  EXPECT_LE(agreement.sameTriangle + agreement.ties, few) << agreement;
  EXPECT_LE(agreement.missed + agreement.elsewhere, few) << agreement;
  EXPECT_LE(agreement.shadows, few) << agreement;
}

std::vector<Ray> randomRays(uint32_t count, float spread, uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(-1, 1);
  std::vector<Ray> rays;
  for (uint32_t i = 0; i < count; ++i) {
    const glm::vec3 origin = spread * glm::vec3(unit(random), unit(random), unit(random));
    rays.push_back({origin, 0, test::randomDirection(random), i % 4 == 0 ? spread : kUnbounded});
  }
  return rays;
}

Scene instancedScene() {
  std::vector<Mesh> meshes;
  for (uint32_t i = 0; i < 4; ++i) meshes.push_back(test::meshOf(test::triangleSoup(7 + 10 * i, 0.8f, 3 + i)));
  Scene scene = test::sceneOf(std::move(meshes));
  scene.instances.clear();
  std::mt19937 random(3);
  for (uint32_t i = 0; i < 60; ++i) {
    Instance instance;
    instance.mesh = i % 4;
    instance.worldFromObject = test::randomPlacement(random, 8);
    scene.instances.push_back(instance);
  }
  return scene;
}

} // namespace

using RayQueryHits = test::RayQueryTest;

TEST_F(RayQueryHits, AgreeInATriangleSoup) {
  const auto rays = randomRays(8000, 1.5f, 2);
  expectAgreement(compare(device(), test::sceneOf({test::meshOf(test::triangleSoup(600, 0.3f, 1))}), rays, 1.5),
                  rays.size());
}

TEST_F(RayQueryHits, AgreeAmongMirroredAndStretchedInstances) {
  const auto rays = randomRays(8000, 10, 4);
  expectAgreement(compare(device(), instancedScene(), rays, 10), rays.size());
}

TEST_F(RayQueryHits, AgreeAtTinyAndHugeScales) {
  for (const float scale : {1e-9f, 1e-3f, 1e6f, 1e12f}) {
    std::vector<glm::vec3> positions = test::triangleSoup(300, 0.4f, 5);
    for (glm::vec3& p : positions) p *= scale;
    std::vector<Ray> rays = randomRays(2000, 1.5f, 6);
    for (Ray& ray : rays) {
      ray.origin *= scale;
      if (ray.tMax < kUnbounded) ray.tMax *= scale;
    }
    SCOPED_TRACE(scale);
    expectAgreement(compare(device(), test::sceneOf({test::meshOf(positions)}), rays, 1.5 * double{scale}),
                    rays.size());
  }
}

TEST_F(RayQueryHits, AgreeAmongDegenerateTriangles) {
  std::vector<glm::vec3> positions = test::triangleSoup(300, 0.4f, 7);
  for (size_t i = 0; i + 2 < positions.size(); i += 9) {
    positions[i + 2] = i % 2 == 0 ? positions[i] : 0.5f * positions[i] + 0.5f * positions[i + 1]; // a line
  }
  for (size_t i = 3; i + 2 < positions.size(); i += 45) positions[i + 1] = positions[i + 2] = positions[i]; // a point
  const auto rays = randomRays(4000, 1.5f, 8);
  expectAgreement(compare(device(), test::sceneOf({test::meshOf(positions)}), rays, 1.5), rays.size());
}

TEST_F(RayQueryHits, AgreeAboutBlendedAndMaskedSurfaces) {
  // One mesh of three materials, so that both backends number instances alike and draw the same numbers.
  Scene scene = test::sceneOf({test::meshOf(test::triangleSoup(200, 0.5f, 9))});
  scene.materials.resize(3, scene.materials[0]);
  scene.materials[1].alphaMode = AlphaMode::Blend;
  scene.materials[1].baseColor.a = 0.5f;
  scene.materials[2].alphaMode = AlphaMode::Mask;
  scene.materials[2].alphaCutoff = 0.5f;
  for (uint32_t material = 1; material < 3; ++material) {
    Primitive primitive = test::meshOf(test::triangleSoup(200, 0.5f, 9 + material), {}, material).primitives[0];
    for (size_t i = 0; i < primitive.positions.size(); ++i)
      primitive.colors.emplace_back(1, 1, 1, i % 3 == 0 ? 1.0f : 0.25f);
    scene.meshes[0].primitives.push_back(primitive);
  }
  const auto rays = randomRays(6000, 1.5f, 10);
  expectAgreement(compare(device(), scene, rays, 1.5), rays.size());
}

TEST_F(RayQueryHits, AgreeAboutSphereLights) {
  Scene scene = test::sceneOf({test::meshOf(test::triangleSoup(100, 0.4f, 11))});
  std::mt19937 random(12);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int i = 0; i < 40; ++i) {
    PunctualLight light;
    light.position = {unit(random), unit(random), unit(random)};
    light.intensity = glm::vec3(1);
    light.radius = 0.15f;
    scene.lights.push_back(light);
  }
  const auto rays = randomRays(6000, 1.5f, 13);
  const Agreement agreement = compare(device(), scene, rays, 1.5);
  expectAgreement(agreement, rays.size());
}

// Rays from inside a sphere straight at its vertices and edges, where rounding decides which triangle. The own BVH lets
// none out; the specification asks devices for as much, but lavapipe (Mesa 25.0.7) loses 30 of these 2,880.
TEST_F(RayQueryHits, AimedAtEdgesAndVerticesAreFewOfThemLost) {
  const Mesh room = test::sphereMesh({0, 0, 0}, 1, 16);
  const Primitive& walls = room.primitives[0];
  std::mt19937 random(14);
  std::uniform_real_distribution<float> unit(-0.3f, 0.3f);
  std::vector<Ray> rays;
  for (size_t i = 0; i + 2 < walls.indices.size(); i += 3) {
    const glm::vec3 a = walls.positions[walls.indices[i]], b = walls.positions[walls.indices[i + 1]];
    const glm::vec3 origin(unit(random), unit(random), unit(random));
    for (const glm::vec3& target : {a, 0.5f * (a + b), 0.25f * a + 0.75f * b})
      rays.push_back({origin, 0, target - origin, kUnbounded});
  }
  const Agreement agreement = compare(device(), test::sceneOf({room}), rays, 1);
  EXPECT_EQ(agreement.hits, rays.size());
  EXPECT_LE(agreement.missed, rays.size() / 50) << agreement;
  EXPECT_EQ(agreement.missed, agreement.shadows) << agreement;
  EXPECT_EQ(agreement.elsewhere, 0u) << agreement;
}

TEST_F(RayQueryHits, NoneOfManyInARoomIsLost) {
  std::vector<Ray> rays = randomRays(60000, 0.4f, 16);
  for (Ray& ray : rays) ray.tMax = kUnbounded;
  const Agreement agreement = compare(device(), test::sceneOf({test::sphereMesh({0, 0, 0}, 1, 16)}), rays, 1);
  EXPECT_EQ(agreement.sameBits, rays.size()) << agreement;
  EXPECT_EQ(agreement.shadows, 0u) << agreement;
}

TEST_F(RayQueryHits, EmptyScenesAreMissed) {
  const Traced traced(device(), Scene{}, randomRays(100, 1, 15), Backend::RayQuery);
  for (size_t i = 0; i < traced.hits.size(); ++i) EXPECT_FALSE(traced.met(i) || traced.occluded[i]);
}
