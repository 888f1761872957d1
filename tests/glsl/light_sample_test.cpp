#include "glsl/light_sample_case.h"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "glsl/light_scene.hpp"
#include "gpu/texture_array.hpp"
#include "render/setting_ids.hpp"
#include "support/probe.hpp"
#include "support/statistics.hpp"
#include "test_glsl_kernels.hpp"

namespace isophote {
namespace {

using gpu::LightSampleCase;
using gpu::LightSampleResult;

constexpr double kPi = std::numbers::pi;
// Ids in shared/features.inc.
constexpr gpu::SpecConstant kNoTextures{1, 0};
constexpr gpu::SpecConstant kNoTriangles{6, 0};
constexpr gpu::SpecConstant kNoPunctual{7, 0};
constexpr gpu::SpecConstant kNoEnvironment{8, 0};
// Of shared/settings.inc.
constexpr gpu::SpecConstant kByArea{setting_id::kTriangleLightSampling, 0};
constexpr gpu::SpecConstant kBySolidAngle{setting_id::kTriangleLightSampling, 1};

std::vector<LightSampleResult> run(uint64_t scene, const std::vector<LightSampleCase>& cases,
                                   const std::vector<gpu::SpecConstant>& constants = {kNoTextures, kByArea}) {
  return test::runProbe<LightSampleCase, LightSampleResult>(test_glsl_kernels::kernelSource("light_sample_probe"),
                                                            cases, scene, constants);
}

float lattice(uint32_t bits) { return std::ldexp(static_cast<float>(bits >> 8), -24); }

std::vector<LightSampleCase> randomCases(uint32_t count, float spread) {
  std::mt19937 generator(22);
  std::normal_distribution<float> normal;
  const auto bits = [&] { return static_cast<uint32_t>(generator()); };
  std::vector<LightSampleCase> cases(count);
  for (auto& c : cases) {
    c.p = spread * glm::vec3(normal(generator), normal(generator), normal(generator));
    c.choiceBits = {bits(), bits()};
    c.u = {lattice(bits()), lattice(bits())};
  }
  return cases;
}

gpu::InstanceRecord instance(const glm::dmat4& worldFromObject, uint32_t firstEmitter) {
  const glm::dmat4 objectFromWorld = glm::inverse(worldFromObject);
  gpu::InstanceRecord record{};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      record.worldFromObject[row][column] = static_cast<float>(worldFromObject[column][row]);
      record.objectFromWorld[row][column] = static_cast<float>(objectFromWorld[column][row]);
    }
  }
  record.firstEmitter = firstEmitter;
  record.flags = glm::determinant(glm::dmat3(worldFromObject)) < 0 ? gpu::kInstanceMirrored : 0u;
  return record;
}

gpu::Geometry geometry(uint32_t material, uint32_t firstEmissive) {
  gpu::Geometry result{};
  result.firstNormal = result.firstTangent = result.firstColor = gpu::kInvalidIndex;
  for (uint32_t& uv : result.firstUv) uv = gpu::kInvalidIndex;
  result.material = material;
  result.firstEmissive = firstEmissive;
  return result;
}

gpu::MaterialRecord emitter(glm::vec3 radiance, uint32_t flags) {
  gpu::MaterialRecord material{};
  material.baseColor = glm::vec4(1);
  material.emissive = radiance;
  material.flags = flags;
  material.baseColorSlot = material.emissiveSlot = gpu::kInvalidIndex;
  return material;
}

glm::dmat4 affine(glm::dvec3 x, glm::dvec3 y, glm::dvec3 z, glm::dvec3 origin) {
  return {glm::dvec4(x, 0), glm::dvec4(y, 0), glm::dvec4(z, 0), glm::dvec4(origin, 1)};
}

/// Two instances of a mesh of two geometries (two single-sided triangles, one double-sided), one sheared, one mirrored;
/// a spot light; an environment.
struct MixedScene {
  test::LightScene scene;
  std::vector<glm::dmat4> transforms{affine({2, 0.1, 0}, {0.3, 1, 0.2}, {0, 0.5, 1.5}, {1, 2, 3}),
                                     affine({-1, 0, 0.2}, {0, 0.7, 0}, {0.1, 0, 1}, {-3, 0.5, -2})};

  MixedScene() {
    scene.triangles = {{{0, 0, 0}, 1, {1, 0, 0}, 0, {0, 1, 0}, gpu::kTriangleEmissive},
                       {{2, 0, 1}, 0, {3, 0, 1}, 1, {2, 0.2f, 1.5f}, gpu::kTriangleEmissive},
                       {{0, 0, 2}, 0, {1, 0, 2.5f}, 0, {0.5f, 1, 2}, gpu::kTriangleEmissive}};
    scene.geometries = {geometry(0, 0), geometry(1, 2)};
    scene.materials = {emitter({1, 2, 3}, 0), emitter({4, 5, 6}, gpu::kMaterialDoubleSided)};
    for (uint32_t i = 0; i < 2; ++i) {
      scene.instances.push_back(instance(transforms[i], 3 * i));
      for (const uint32_t triangle : {2u, 0u, 1u}) scene.emissiveTriangles.push_back({i, triangle}); // by primitive
    }
    gpu::PunctualLightRecord spot{};
    spot.position = {0, 5, 0};
    spot.kind = gpu::kLightSpot;
    spot.direction = {0, -1, 0};
    spot.intensity = {9, 8, 7};
    spot.cosInner = 0.9f;
    spot.cosOuter = 0.2f;
    gpu::PunctualLightRecord sun{};
    sun.kind = gpu::kLightDirectional;
    sun.direction = {0.6f, -0.8f, 0};
    sun.intensity = {2, 2, 1};
    scene.punctualLights = {spot, sun};
    scene.environment.width = 4;
    scene.environment.height = 2;
    scene.environment.pixels = {{1, 1, 1}, {2, 1, 0}, {0, 1, 2}, {5, 5, 5}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {2, 2, 2}};
    scene.environment.rotation = 0.5;
    scene.powers = {1, 2, 3, 4, 5, 6, 7, 8, 9};
  }

  [[nodiscard]] double pmf(uint32_t light) const { return scene.powers[light] / 45; }
  /// Corners in world space.
  [[nodiscard]] std::array<glm::dvec3, 3> corners(uint32_t light) const {
    const auto& triangle = scene.triangles[scene.emissiveTriangles[light].triangle];
    const glm::dmat4& m = transforms[scene.emissiveTriangles[light].instance];
    const auto map = [&](const glm::vec3& v) { return glm::dvec3(m * glm::dvec4(v, 1)); };
    return {map(triangle.v0), map(triangle.v1), map(triangle.v2)};
  }
  /// The front's unit normal: counter-clockwise in object space, taken along by mirroring.
  [[nodiscard]] glm::dvec3 normal(uint32_t light) const {
    const auto v = corners(light);
    const double side = glm::determinant(transforms[scene.emissiveTriangles[light].instance]) < 0 ? -1 : 1;
    return side * glm::normalize(glm::cross(v[1] - v[0], v[2] - v[0]));
  }
  [[nodiscard]] double area(uint32_t light) const {
    const auto v = corners(light);
    return 0.5 * glm::length(glm::cross(v[1] - v[0], v[2] - v[0]));
  }
};

TEST(LightSample, TrianglesMatchTheirDefinitionInDouble) {
  MixedScene mixed;
  const auto cases = randomCases(50'000, 4);
  const auto results = run(mixed.scene.address(), cases);
  int checked = 0;
  int dark = 0;
  for (size_t i = 0; i < cases.size(); ++i) {
    const auto& s = results[i];
    if (s.light >= 6) continue;
    const bool doubleSided = s.light % 3 == 2;
    const glm::dvec3 n = mixed.normal(s.light);
    const auto v = mixed.corners(s.light);
    const glm::dvec3 p(cases[i].p);
    const double side = glm::dot(p - v[0], n);
    if (std::abs(side) < 1e-4) continue;
    if (!doubleSided && side < 0) {
      ASSERT_EQ(s.valid, 0u) << i;
      ++dark;
      continue;
    }
    ASSERT_EQ(s.valid, 1u) << i;
    const glm::dvec3 point(s.point);
    ASSERT_LT(std::abs(glm::dot(point - v[0], n)), 3e-6) << i; // on the plane
    for (int axis = 0; axis < 3; ++axis) {
      const double lower = std::min({v[0][axis], v[1][axis], v[2][axis]});
      const double upper = std::max({v[0][axis], v[1][axis], v[2][axis]});
      ASSERT_TRUE(point[axis] >= lower - 3e-6 && point[axis] <= upper + 3e-6) << i;
      ASSERT_TRUE(s.pointError[axis] >= 0 && s.pointError[axis] < 1e-4) << i;
    }
    ASSERT_NEAR(glm::dot(glm::dvec3(s.ngLight), n), 1, 1e-6) << i;
    const glm::dvec3 toLight = point - p;
    const double distance = glm::length(toLight);
    ASSERT_NEAR(s.distance / distance, 1, 1e-6) << i;
    ASSERT_LT(glm::length(glm::dvec3(s.wi) - toLight / distance), 1e-6) << i;
    const double cosLight = std::abs(glm::dot(toLight, n)) / distance;
    const double pdf = mixed.pmf(s.light) / mixed.area(s.light) * distance * distance / cosLight;
    ASSERT_NEAR(s.pdfSolidAngle / pdf, 1, 2e-6 + 1e-6 / cosLight) << i;
    ASSERT_EQ(s.radiance, mixed.scene.materials[doubleSided ? 1 : 0].emissive) << i;
    ASSERT_EQ(s.delta | s.atInfinity, 0u) << i;
    ++checked;
  }
  EXPECT_GT(checked, 10'000);
  EXPECT_GT(dark, 3'000);
}

class LightSampleBy : public testing::TestWithParam<gpu::SpecConstant> {};
INSTANTIATE_TEST_SUITE_P(TriangleSampling, LightSampleBy, testing::Values(kByArea, kBySolidAngle),
                         [](const auto& tested) { return tested.param.value == 0 ? "Area" : "SolidAngle"; });

TEST_P(LightSampleBy, WhatLightSamplingSaysARayThatHitsIsToldToo) {
  MixedScene mixed;
  const auto cases = randomCases(50'000, 4);
  const auto results = run(mixed.scene.address(), cases, {kNoTextures, GetParam()});
  size_t mapEdges = 0;
  for (size_t i = 0; i < cases.size(); ++i) {
    const auto& s = results[i];
    if (s.valid == 0u || s.delta != 0u) continue;
    if (s.light == 8 && std::abs(s.hitPdf / s.pdfSolidAngle - 1) > 1e-5) {
      ++mapEdges; // rounding put the direction into the next texel
      continue;
    }
    ASSERT_NEAR(s.hitPdf / s.pdfSolidAngle, 1, 1e-5) << i << " light " << s.light;
    ASSERT_LT(glm::length(s.hitRadiance - s.radiance), 1e-4f) << i;
  }
  EXPECT_LE(mapEdges, 2u);
}

TEST(LightSample, PunctualLightsCarryTheirProbabilityAndAreDelta) {
  MixedScene mixed;
  const auto cases = randomCases(20'000, 2);
  const auto results = run(mixed.scene.address(), cases);
  for (size_t i = 0; i < cases.size(); ++i) {
    const auto& s = results[i];
    if (s.light == 7) {
      ASSERT_EQ(s.valid & s.delta & s.atInfinity, 1u);
      ASSERT_NEAR(s.pdfSolidAngle, mixed.pmf(7), 1e-6);
      ASSERT_EQ(s.radiance, glm::vec3(2, 2, 1));
      ASSERT_EQ(s.wi, glm::vec3(-0.6f, 0.8f, 0));
    } else if (s.light == 6 && s.valid != 0u) {
      ASSERT_EQ(s.delta, 1u);
      ASSERT_EQ(s.atInfinity, 0u);
      ASSERT_EQ(s.point, glm::vec3(0, 5, 0));
      ASSERT_NEAR(s.pdfSolidAngle, mixed.pmf(6), 1e-6);
      ASSERT_NEAR(s.distance, glm::length(glm::vec3(0, 5, 0) - cases[i].p), 1e-5f);
    }
    ASSERT_EQ(s.pointError, s.light == 6 || s.light == 7 ? glm::vec3(0) : s.pointError);
  }
}

TEST(LightSample, AbsentKindsOfLightCanBeCompiledAway) {
  MixedScene all;
  const auto cases = randomCases(20'000, 3);
  const auto only = [&](const auto& keep, const std::vector<gpu::SpecConstant>& constants) {
    MixedScene mixed;
    keep(mixed.scene);
    const uint64_t address = mixed.scene.address();
    const auto general = run(address, cases, {kNoTextures});
    const auto specialized = run(address, cases, constants);
    for (size_t i = 0; i < cases.size(); ++i) {
      ASSERT_EQ(general[i].light, specialized[i].light);
      ASSERT_EQ(general[i].valid, specialized[i].valid);
      ASSERT_EQ(general[i].radiance, specialized[i].radiance);
      ASSERT_EQ(general[i].pdfSolidAngle, specialized[i].pdfSolidAngle);
      ASSERT_EQ(general[i].hitPdf, specialized[i].hitPdf);
    }
  };
  only(
      [](test::LightScene& s) {
        s.punctualLights.clear();
        s.environment.pixels.clear();
        s.powers.resize(6);
      },
      {kNoTextures, kNoPunctual, kNoEnvironment});
  only(
      [](test::LightScene& s) {
        s.emissiveTriangles.clear();
        s.environment.pixels.clear();
        s.powers = {1, 2};
      },
      {kNoTextures, kNoTriangles, kNoEnvironment});
  only(
      [](test::LightScene& s) {
        s.emissiveTriangles.clear();
        s.punctualLights.clear();
        s.powers = {1};
      },
      {kNoTextures, kNoTriangles, kNoPunctual});
}

TEST(LightSample, SceneWithoutLightsGivesNoSample) {
  test::LightScene empty;
  for (const auto& s : run(empty.address(), randomCases(100, 1))) EXPECT_EQ(s.valid, 0u);
}

TEST(LightSample, LightsWithoutPowerAreNeverValidAndHaveNoDensity) {
  MixedScene mixed;
  mixed.scene.powers = {0, 2, 0, 0, 0, 0, 0, 0, 0};
  for (const auto& s : run(mixed.scene.address(), randomCases(5'000, 4))) {
    ASSERT_EQ(s.light, 1u);
    if (s.valid != 0u) {
      ASSERT_NEAR(s.hitPdf / s.pdfSolidAngle, 1, 1e-5);
    }
  }
}

/// Irradiance at the origin, facing +z, of a uniform polygon (Lambert 1760): a closed form in the angles between
/// corners.
double lambertPolygon(const std::array<glm::dvec3, 3>& v) {
  double sum = 0;
  for (size_t i = 0; i < 3; ++i) {
    const glm::dvec3 a = glm::normalize(v[i]);
    const glm::dvec3 b = glm::normalize(v[(i + 1) % 3]);
    const glm::dvec3 across = glm::cross(a, b);
    sum += std::atan2(glm::length(across), glm::dot(a, b)) * glm::normalize(across).z;
  }
  return std::abs(sum) / 2;
}

// 5 triangles above the receiver, one light each; 1e6 samples: half width of the t-test about 0.25% of the irradiance.
TEST_P(LightSampleBy, TriangleIrradianceMatchesLambertsFormula) {
  std::mt19937 generator(6);
  std::uniform_real_distribution<float> unit(-1, 1);
  for (int scene = 0; scene < 5; ++scene) {
    test::LightScene lights;
    gpu::BvhTriangle triangle{};
    for (glm::vec3* v : {&triangle.v0, &triangle.v1, &triangle.v2}) {
      *v = {unit(generator), unit(generator), 1.5f + 0.5f * unit(generator)};
    }
    triangle.flags = gpu::kTriangleEmissive;
    lights.triangles = {triangle};
    lights.geometries = {geometry(0, 0)};
    lights.materials = {emitter(glm::vec3(1), gpu::kMaterialDoubleSided)};
    lights.instances = {instance(glm::dmat4(1), 0)};
    lights.emissiveTriangles = {{0, 0}};
    lights.powers = {1};
    auto cases = randomCases(400'000, 0);
    test::Moments irradiance;
    for (const auto& s : run(lights.address(), cases, {kNoTextures, GetParam()})) {
      irradiance.add(s.valid != 0u ? static_cast<double>(s.radiance.r) * std::max(0.0f, s.wi.z) /
                                         static_cast<double>(s.pdfSolidAngle)
                                   : 0.0);
    }
    const double expected = lambertPolygon({glm::dvec3(triangle.v0), glm::dvec3(triangle.v1), glm::dvec3(triangle.v2)});
    const double level = test::sidak(0.001, 5);
    EXPECT_GT(test::meanTest(irradiance, expected), level) << irradiance.mean() << " " << expected;
    EXPECT_LT(test::normalTwoSidedQuantile(level) * irradiance.standardError(), 0.003 * expected);
  }
}

TEST(LightSample, CoverageOfMaskedAndBlendedEmittersScalesTheSample) {
  const auto radiance = [](uint32_t mode, float alpha) {
    MixedScene mixed;
    for (auto& triangle : mixed.scene.triangles) triangle.flags |= gpu::kTriangleHasAlpha;
    for (auto& material : mixed.scene.materials) {
      material.alphaMode = mode;
      material.alphaCutoff = 0.5f;
      material.baseColor.a = alpha;
    }
    mixed.scene.powers = {0, 0, 1, 0, 0, 0, 0, 0, 0}; // the double-sided one
    const auto s = run(mixed.scene.address(), randomCases(1, 1))[0];
    return s.valid != 0u ? s.radiance.r / 4 : 0;
  };
  EXPECT_EQ(radiance(gpu::kAlphaOpaque, 0.25f), 1);
  EXPECT_EQ(radiance(gpu::kAlphaBlend, 0.25f), 0.25f);
  EXPECT_EQ(radiance(gpu::kAlphaMask, 0.25f), 0);
  EXPECT_EQ(radiance(gpu::kAlphaMask, 0.75f), 1);
}

TEST(LightSample, EmissiveTextureIsReadAtThePoint) {
  MixedScene mixed;
  ImageData image;
  image.width = 2;
  image.height = 1;
  image.pixels = {std::byte{255}, std::byte{0},   std::byte{0}, std::byte{255},
                  std::byte{0},   std::byte{255}, std::byte{0}, std::byte{255}};
  gpu::TextureUpload upload;
  upload.image = &image;
  upload.wrapS = upload.wrapT = Wrap::ClampToEdge;
  upload.filter = Filter::Nearest;
  const gpu::TextureArray textures(test::gpuDevice(), std::span(&upload, 1));
  mixed.scene.textureSlots = {{0, 0, 1, {1, 0, 0}, {0, 1, 0}}};
  mixed.scene.materials[1].emissiveSlot = 0;
  mixed.scene.geometries[1].firstUv[0] = 0;
  mixed.scene.uvs = {{0, 0.5f}, {1, 0.5f}, {0, 0.5f}}; // u is the weight of the second corner
  mixed.scene.indices = {0, 1, 2};
  mixed.scene.powers = {0, 0, 1, 0, 0, 0, 0, 0, 0};
  const auto cases = randomCases(2000, 4);
  const auto results = test::runProbe<LightSampleCase, LightSampleResult>(
      test_glsl_kernels::kernelSource("light_sample_probe"), cases,
      test::ProbeEnvironment{.extra = mixed.scene.address(), .constants = {}, .textures = &textures});
  const auto v = mixed.corners(2);
  int red = 0;
  for (const auto& s : results) {
    ASSERT_EQ(s.valid, 1u);
    const glm::dvec3 e1 = v[1] - v[0];
    const glm::dvec3 e2 = v[2] - v[0];
    const glm::dvec3 n = glm::cross(e1, e2);
    const double weight = glm::dot(glm::cross(glm::dvec3(s.point) - v[0], e2), n) / glm::dot(n, n);
    if (std::abs(weight - 0.5) < 1e-4) continue;
    ASSERT_EQ(s.radiance, weight < 0.5 ? glm::vec3(4, 0, 0) : glm::vec3(0, 5, 0));
    red += weight < 0.5;
  }
  EXPECT_NEAR(red / 2000.0, 0.75, 0.05);
}

} // namespace
} // namespace isophote
