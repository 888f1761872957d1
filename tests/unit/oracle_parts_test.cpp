// The reference tracer's parts: tree against brute force, texture rules, environment sampling, punctual falloff.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "oracle/environment_map.hpp"
#include "oracle/light_list.hpp"
#include "oracle/reference_camera.hpp"
#include "oracle/texture_lookup.hpp"
#include "oracle/triangle_tree.hpp"
#include "support/scenes.hpp"

namespace isophote::oracle {
namespace {

using namespace isophote::test;

TEST(ReferenceTree, FindsTheSameHitsAsBruteForce) {
  const TriangleTree tree(flattenScene(instanceGrid()));
  std::mt19937_64 engine(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  int found = 0;
  for (int i = 0; i < 5000; ++i) {
    Ray ray;
    ray.origin = 4.0 * glm::dvec3(uniform(engine), 0.5 + 0.5 * uniform(engine), uniform(engine));
    ray.direction = glm::normalize(glm::dvec3(uniform(engine), uniform(engine), uniform(engine)));
    if (i % 10 == 0) ray.direction = {0, -1, 0}; // infinite slab distances
    Hit expected;
    for (uint32_t index = 0; index < tree.triangles().size(); ++index) {
      Hit hit;
      hit.triangle = index;
      if (intersectTriangle(tree.triangles()[index], ray, hit) && hit.t < expected.t) expected = hit;
    }
    const Hit actual = tree.closest(ray, [](const Hit&) { return true; });
    ASSERT_EQ(actual.t, expected.t);
    ASSERT_EQ(tree.occluded(ray, [](const Hit&) { return true; }), expected.triangle != kNoTriangle);
    found += expected.triangle != kNoTriangle ? 1 : 0;
  }
  EXPECT_GT(found, 1000);
}

TEST(ReferenceSoup, MirroredInstancesKeepTheirFrontSide) {
  Scene scene;
  addPrimitive(
      scene, facingQuad(1, 1, addMaterial(scene, lambert(glm::vec3(1)))),
      glm::dmat4(glm::dvec4(-1, 0, 0, 0), glm::dvec4(0, 1, 0, 0), glm::dvec4(0, 0, 1, 0), glm::dvec4(0, 0, 0, 1)));
  for (const Triangle& triangle : flattenScene(scene)) EXPECT_EQ(triangle.ng, glm::dvec3(0, 0, 1));
  for (const Triangle& triangle : flattenScene(flattened(scene))) EXPECT_EQ(triangle.ng, glm::dvec3(0, 0, 1));
}

TEST(ReferenceTexture, DecodesSrgbAndInterpolatesBetweenTexelCenters) {
  Scene scene;
  const uint32_t linear = addTexture(scene, 2, 1, {{0, 255, 188, 0}, {255, 0, 188, 255}});
  const uint32_t nearest = addTexture(scene, 2, 1, {{0, 255, 188, 0}, {255, 0, 188, 255}}, Filter::Nearest);
  const auto read = [&](uint32_t texture, double u, Encoding encoding) {
    return lookUp(scene, scene.textures[texture], {u, 0.3}, encoding);
  };
  EXPECT_NEAR(decodeSrgb(188.0 / 255), 0.50289, 1e-5); // IEC 61966-2-1
  EXPECT_EQ(read(linear, 0.25, Encoding::Srgb).x, 0);  // center of texel 0
  EXPECT_EQ(read(linear, 0.75, Encoding::Srgb).x, 1);
  EXPECT_EQ(read(linear, 0.5, Encoding::Srgb).x, 0.5); // decoded before interpolation
  EXPECT_EQ(read(linear, 0.5, Encoding::Srgb).w, 0.5);
  EXPECT_NEAR(read(linear, 0.3, Encoding::Srgb).z, 0.50289, 1e-5);
  EXPECT_NEAR(read(linear, 0.3, Encoding::Linear).z, 188.0 / 255, 1e-12);
  EXPECT_EQ(read(linear, 0.0, Encoding::Linear).x, 0.5); // repeats: half of each texel
  EXPECT_EQ(read(nearest, 0.499, Encoding::Linear).x, 0);
  EXPECT_EQ(read(nearest, 0.501, Encoding::Linear).x, 1);
}

TEST(ReferenceTexture, WrapModesFollowGltf) {
  const auto wrap = [](int64_t index, Wrap mode) { return wrapTexel(index, 3, mode); };
  const std::array<uint32_t, 8> repeated{0, 1, 2, 0, 1, 2, 0, 1}, mirrored{2, 1, 0, 0, 1, 2, 2, 1},
      clamped{0, 0, 0, 0, 1, 2, 2, 2};
  for (int64_t i = -3; i < 5; ++i) {
    const auto at = static_cast<size_t>(i + 3);
    EXPECT_EQ(wrap(i, Wrap::Repeat), repeated[at]);
    EXPECT_EQ(wrap(i, Wrap::MirroredRepeat), mirrored[at]);
    EXPECT_EQ(wrap(i, Wrap::ClampToEdge), clamped[at]);
  }
}

TEST(ReferenceEnvironment, AxesFollowTheConvention) {
  Environment environment = oneTexelEnvironment(4, 1, 2, 0, glm::vec3(1)); // u in [0.5, 0.75]: between -z and +x
  const auto brightest = [&](double rotation, glm::dvec3 d) {
    environment.rotation = rotation;
    return EnvironmentMap(environment).radiance(glm::normalize(d)).x;
  };
  EXPECT_NEAR(brightest(0, {1, 0, -1}), 1, 1e-12);
  EXPECT_NEAR(brightest(0, {-1, 0, 1}), 0, 1e-12);
  // Turned by a quarter about +y (counter-clockwise seen from above): +x goes to -z, -z to -x.
  EXPECT_NEAR(brightest(kPi / 2, {-1, 0, -1}), 1, 1e-12);
}

TEST(ReferenceEnvironment, SamplesFollowTheirDensityAndReachAllRadiance) {
  Environment environment = oneTexelEnvironment(8, 4, 3, 0, {5, 2, 1});
  environment.pixels[17] = {0.5f, 1, 4};
  environment.rotation = 1.1;
  const EnvironmentMap map(environment);
  RandomStream random(3, 0, 0);
  // The mean of radiance / pdf is the integral over the sphere: compare with uniform directions. 4e5 samples of
  // relative deviation about 1 and 4: differences of 3% would be seen at 4.9 sigma.
  glm::dvec3 byImportance(0), uniformly(0);
  constexpr int kCount = 400000;
  for (int i = 0; i < kCount; ++i) {
    const double u = random.next();
    const glm::dvec3 d = map.sample(u, random.next2());
    ASSERT_NEAR(glm::length(d), 1, 1e-9);
    ASSERT_GT(map.pdf(d), 0);
    byImportance += map.radiance(d) / map.pdf(d);
    const double z = 2 * random.next() - 1, phi = 2 * kPi * random.next(), r = std::sqrt(1 - z * z);
    uniformly += map.radiance({r * std::cos(phi), z, r * std::sin(phi)}) * (4 * kPi);
  }
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(byImportance[c] / uniformly[c], 1, 0.04);
}

TEST(ReferenceLights, SpotAndRangeFollowKhrLightsPunctual) {
  PunctualLight light;
  light.kind = LightKind::Spot;
  light.intensity = glm::vec3(8);
  light.direction = {0, -1, 0};
  light.innerConeAngle = 0.3f;
  light.outerConeAngle = 0.8f;
  const auto at = [&](double angle) {
    return punctualIrradiance(light, 2.0 * glm::dvec3(std::sin(angle), -std::cos(angle), 0)).x;
  };
  EXPECT_NEAR(at(0), 2, 1e-12);
  EXPECT_NEAR(at(0.29), 2, 1e-12);
  EXPECT_EQ(at(0.81), 0);
  const double share = (std::cos(0.5) - std::cos(double(0.8f))) / (std::cos(double(0.3f)) - std::cos(double(0.8f)));
  EXPECT_NEAR(at(0.5), 2 * share * share, 1e-12);
  light.range = 4;
  EXPECT_NEAR(at(0), 2 * (1 - std::pow(0.5, 4)), 1e-12);
  light.range = 1.9f;
  EXPECT_EQ(at(0), 0);
}

TEST(ReferenceCamera, CornersAndClippingFollowTheConvention) {
  Camera camera = lookAt({1, 2, 3}, {1, 2, 2}, kPi / 2);
  camera.znear = 0.5;
  camera.zfar = 10;
  const Ray upperLeft = cameraRay(camera, 20, 10, {0, 0});
  const glm::dvec3 expected = glm::normalize(glm::dvec3(-2, 1, -1));
  EXPECT_NEAR(glm::distance(upperLeft.direction, expected), 0, 1e-12);
  EXPECT_NEAR(upperLeft.tMin * -expected.z, 0.5, 1e-12);
  EXPECT_NEAR(upperLeft.tMax * -expected.z, 10, 1e-12);
  const Ray parallel = cameraRay(orthographicLookAt({0, 0, 5}, {}, 2, 1), 20, 10, {20, 10});
  EXPECT_NEAR(glm::distance(parallel.origin, glm::dvec3(2, -1, 5)), 0, 1e-12);
  EXPECT_NEAR(glm::distance(parallel.direction, glm::dvec3(0, 0, -1)), 0, 1e-12);
}

} // namespace
} // namespace isophote::oracle
