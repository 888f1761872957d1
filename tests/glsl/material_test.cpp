#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "glsl/material_case.h"
#include "gpu/texture_array.hpp"
#include "isophote/features.hpp"
#include "isophote/settings.hpp"
#include "oracle/bsdf_metallic_roughness.hpp"
#include "oracle/bsdf_shading_normal.hpp"
#include "render/setting_ids.hpp"
#include "shared/geometry_types.h"
#include "shared/material_types.h"
#include "shared/scene_view.h"
#include "support/gpu_device.hpp"
#include "support/probe.hpp"
#include "test_glsl_kernels.hpp"

using namespace isophote;
using gpu::MaterialCase;
using gpu::MaterialResult;

namespace {

// Two texels side by side, read without filtering at u < 0.5 and u > 0.5.
ImageData twoTexels(glm::u8vec4 left, glm::u8vec4 right) {
  ImageData image{.name = "two texels", .width = 2, .height = 1};
  for (const glm::u8vec4& texel : {left, right}) {
    for (int c = 0; c < 4; ++c) image.pixels.push_back(static_cast<std::byte>(texel[c]));
  }
  return image;
}

double linearFromSrgb(int value) { // IEC 61966-2-1
  const double x = value / 255.0;
  return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
}

// One triangle with uv (0,0), (1,0), (0,1) in set 0, the same moved by (0.5, 0) in set 1, vertex colors, and the
// materials 0: no textures, 1: every texture, 2: normal map of half scale read through set 1, 3: unlit and overbright,
// 4: every extension with its textures.
class MaterialScene {
public:
  explicit MaterialScene(Filter filter = Filter::Nearest) {
    images_ = {twoTexels({188, 255, 0, 255}, {255, 64, 128, 255}), twoTexels({7, 102, 204, 9}, {0, 255, 51, 0}),
               twoTexels({128, 128, 255, 255}, {200, 80, 180, 255}), twoTexels({0, 0, 0, 51}, {255, 255, 255, 204}),
               twoTexels({255, 188, 0, 255}, {128, 255, 255, 255})};
    std::vector<gpu::TextureUpload> uploads;
    for (size_t i = 0; i < images_.size(); ++i) {
      uploads.push_back({.image = &images_[i], .filter = filter, .srgb = i == 0 || i == 4});
    }
    textures_ = gpu::TextureArray(test::gpuDevice(), uploads);

    gpu::Geometry geometry{.firstIndex = 0,
                           .firstNormal = gpu::kInvalidIndex,
                           .firstTangent = gpu::kInvalidIndex,
                           .firstColor = 0,
                           .firstUv = {0, 3, gpu::kInvalidIndex, gpu::kInvalidIndex},
                           .material = 0,
                           .firstEmissive = gpu::kInvalidIndex};
    geometries_ = upload(std::vector{geometry});
    indices_ = upload(std::vector<uint32_t>{0, 1, 2});
    colors_ = upload(std::vector<glm::vec4>{{1, 0.5f, 1, 1}, {1, 0.5f, 1, 1}, {0.5f, 0.5f, 3, 1}});
    uvs_ = upload(std::vector<glm::vec2>{{0, 0}, {1, 0}, {0, 1}, {0.5f, 0}, {1.5f, 0}, {0.5f, 1}});
    std::vector<gpu::TextureSlot> slots;
    for (uint32_t i = 0; i < 5; ++i) slots.push_back({i, 0, 1, {1, 0, 0}, {0, 1, 0}});
    slots.push_back({2, 1, 0.5f, {1, 0, 0}, {0, 1, 0}});
    slots_ = upload(slots);
    materials_ = upload(materialRecords());
    gpu::SceneView view{.geometries = geometries_.address(),
                        .indices = indices_.address(),
                        .colors = colors_.address(),
                        .uvs = uvs_.address(),
                        .materials = materials_.address(),
                        .textureSlots = slots_.address()};
    view_ = upload(std::vector{view});
  }

  static std::vector<gpu::MaterialRecord> materialRecords() {
    const gpu::MaterialRecord plain{.baseColor = {0.8f, 0.4f, 0.2f, 1},
                                    .emissive = glm::vec3(0),
                                    .metallic = 0.5f,
                                    .specularColor = {1, 0.5f, 0.25f},
                                    .roughness = 0.6f,
                                    .specular = 0.9f,
                                    .ior = 1.4f,
                                    .alphaCutoff = 0,
                                    .alphaMode = gpu::kAlphaOpaque,
                                    .flags = 0,
                                    .baseColorSlot = gpu::kInvalidIndex,
                                    .metallicRoughnessSlot = gpu::kInvalidIndex,
                                    .normalSlot = gpu::kInvalidIndex,
                                    .emissiveSlot = gpu::kInvalidIndex,
                                    .specularSlot = gpu::kInvalidIndex,
                                    .specularColorSlot = gpu::kInvalidIndex,
                                    .clearcoatNormalSlot = gpu::kInvalidIndex};
    gpu::MaterialRecord textured = plain;
    textured.baseColorSlot = 0;
    textured.metallicRoughnessSlot = 1;
    textured.normalSlot = 2;
    textured.specularSlot = 3;
    textured.specularColorSlot = 4;
    gpu::MaterialRecord bumped = plain;
    bumped.normalSlot = 5;
    gpu::MaterialRecord unlit = plain;
    unlit.baseColor = {1, 1, 1, 1};
    unlit.flags = gpu::kMaterialUnlit;
    gpu::MaterialRecord extended = plain;
    extended.metallic = 0.25f;
    extended.clearcoat = 0.8f;
    extended.clearcoatRoughness = 0.7f;
    extended.sheenColor = {0.9f, 0.5f, 0.3f};
    extended.sheenRoughness = 0.6f;
    extended.iridescence = 0.9f;
    extended.iridescenceIor = 1.3f;
    extended.iridescenceThicknessMinimum = 100;
    extended.iridescenceThicknessMaximum = 400;
    extended.transmission = 0.5f;
    extended.diffuseTransmission = 0.4f;
    extended.diffuseTransmissionColor = {0.2f, 0.5f, 1};
    extended.glassLoss = gpu::kInvalidIndex;
    extended.clearcoatSlot = extended.clearcoatRoughnessSlot = extended.sheenRoughnessSlot = 0;
    extended.sheenColorSlot = extended.diffuseTransmissionColorSlot = 4;
    extended.iridescenceSlot = extended.iridescenceThicknessSlot = extended.transmissionSlot = 1;
    extended.diffuseTransmissionSlot = 3;
    extended.anisotropySlot = gpu::kInvalidIndex;
    extended.normalSlot = 2;
    extended.clearcoatNormalSlot = 5;
    return {plain, textured, bumped, unlit, extended};
  }

  [[nodiscard]] std::vector<MaterialResult> evaluate(const std::vector<MaterialCase>& cases,
                                                     std::span<const gpu::SpecConstant> constants = {},
                                                     bool withTextures = true) const {
    return test::runProbe<MaterialCase, MaterialResult>(test_glsl_kernels::kernelSource("material_probe"), cases,
                                                        test::ProbeEnvironment{
                                                            .extra = view_.address(),
                                                            .constants = constants,
                                                            .textures = withTextures ? &textures_ : nullptr,
                                                        });
  }

private:
  template <class T> static gpu::Buffer upload(const std::vector<T>& values) {
    return gpu::uploadBuffer(test::gpuDevice(), values, "test.material");
  }

  std::vector<ImageData> images_;
  gpu::TextureArray textures_;
  gpu::Buffer geometries_, indices_, colors_, uvs_, slots_, materials_, view_;
};

MaterialCase caseOf(uint32_t material, glm::vec2 barycentrics) {
  return {.material = material,
          .barycentrics = barycentrics,
          .ng = {0, 0, 1},
          .ns = {0, 0, 1},
          .tangent = {1, 0, 0, 1},
          .wo = {0, 0, 1},
          .frontFace = 1};
}

void expectNear(const glm::vec3& actual, const glm::dvec3& expected, double tolerance, const char* what) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(double(actual[c]), expected[c], tolerance) << what << " " << c;
}

void expectModel(const MaterialResult& actual, const oracle::MetallicRoughness& expected, double tolerance) {
  expectNear(actual.reflectance, expected.baseColor, tolerance, "base color");
  expectNear(actual.f0, expected.f0, tolerance, "f0");
  expectNear(actual.f90, expected.f90, tolerance, "f90");
  EXPECT_NEAR(double(actual.metallic), expected.metallic, tolerance);
  EXPECT_NEAR(double(actual.alpha), expected.alpha, tolerance);
  EXPECT_NEAR(double(actual.dielectricF0), expected.dielectricF0, tolerance);
  EXPECT_NEAR(double(actual.dielectricF90), expected.dielectricF90, tolerance);
}

// The texel of the test's normal map, decoded.
glm::dvec3 bumpOf(const glm::dvec3& texel, double scale) {
  return glm::normalize((texel / 127.5 - 1.0) * glm::dvec3(scale, scale, 1));
}

const glm::dvec3 kRightTexel(200, 80, 180);

} // namespace

TEST(Material, WithoutTexturesIsItsFactorsTimesTheVertexColor) {
  const MaterialScene scene;
  const auto results = scene.evaluate({caseOf(0, {0.25f, 0.5f}), caseOf(3, {0, 1})});
  expectModel(results[0], oracle::metallicRoughness({0.8 * 0.75, 0.2, 0.2 * 2}, 0.5, 0.6, 1.4, 0.9, {1, 0.5, 0.25}),
              1e-6);
  EXPECT_EQ(results[0].unlit, 0u);
  EXPECT_EQ(results[1].unlit, 1u);
  EXPECT_EQ(results[1].baseColor, glm::vec3(0.5f, 0.5f, 3)) << "an unlit radiance is not cut";
  EXPECT_EQ(results[1].reflectance, glm::vec3(0.5f, 0.5f, 1)) << "a reflectance is";
}

// The tolerance is that of the sampler's sRGB decoding.
TEST(Material, TakesEachFactorFromItsTextureChannel) {
  const MaterialScene scene;
  const auto results = scene.evaluate({caseOf(1, {0.25f, 0}), caseOf(1, {0.75f, 0})});
  const double mid = linearFromSrgb(188);
  expectModel(results[0],
              oracle::metallicRoughness({0.8 * mid, 0.4 * 0.5, 0}, 0.5 * 204 / 255.0, 0.6 * 102 / 255.0, 1.4,
                                        0.9 * 51 / 255.0, {1, 0.5 * mid, 0}),
              1e-3);
  expectModel(results[1],
              oracle::metallicRoughness({0.8, 0.2 * linearFromSrgb(64), 0.2 * linearFromSrgb(128)}, 0.5 * 51 / 255.0,
                                        0.6, 1.4, 0.9 * 204 / 255.0, {linearFromSrgb(128), 0.5, 0.25}),
              1e-3);
}

TEST(Material, TheNearestTexelOfASmoothTextureIsThatOfANearestOne) {
  const gpu::SpecConstant nearest[] = {{setting_id::kTextureFilter, static_cast<uint32_t>(TextureFilter::Nearest)}};
  std::vector<MaterialCase> cases;
  for (int i = -20; i < 30; ++i) cases.push_back(caseOf(1, {static_cast<float>(i) / 10 + 0.03f, 0.2f})); // repeated too
  const MaterialScene smooth(Filter::Linear);
  const auto expected = MaterialScene().evaluate(cases);
  const auto actual = smooth.evaluate(cases, nearest);
  const auto blended = smooth.evaluate(cases);
  size_t different = 0;
  for (size_t i = 0; i < cases.size(); ++i) {
    EXPECT_EQ(actual[i].baseColor, expected[i].baseColor) << i;
    EXPECT_EQ(actual[i].alpha, expected[i].alpha) << i;
    different += blended[i].alpha != expected[i].alpha;
  }
  EXPECT_GT(different, cases.size() / 2);
}

TEST(Material, NormalMapTurnsInTheTangentFrame) {
  const MaterialScene scene;
  MaterialCase right = caseOf(1, {0.75f, 0});
  MaterialCase mirrored = right;
  mirrored.tangent.w = -1;
  MaterialCase turned = right; // tangent +y, long and not orthogonal: bitangent is -x
  turned.tangent = {0, 5, 2, 1};
  const auto results = scene.evaluate({right, mirrored, turned, caseOf(2, {0.25f, 0})});
  const glm::dvec3 bump = bumpOf(kRightTexel, 1);
  expectNear(results[0].ns, bump, 1e-4, "right-handed");
  expectNear(results[1].ns, {bump.x, -bump.y, bump.z}, 1e-4, "mirrored");
  expectNear(results[2].ns, {-bump.y, bump.x, bump.z}, 1e-4, "turned");
  expectNear(results[3].ns, bumpOf(kRightTexel, 0.5), 1e-4, "half scale, second uv set");
}

// Channels as the extensions give them: clearcoat R, its roughness G; sheen color RGB, its roughness A; iridescence R,
// its thickness G between minimum and maximum; transmission R; diffuse transmission A, its color RGB.
TEST(Material, TakesEachFactorOfTheExtensionsFromItsTextureChannel) {
  const MaterialScene scene;
  const MaterialResult result = scene.evaluate({caseOf(4, {0.75f, 0})})[0]; // the right texels
  constexpr double kTolerance = 1e-3;
  EXPECT_NEAR(double(result.coat.x), 0.8 * 1, kTolerance);
  EXPECT_NEAR(double(result.coat.y), 0.7 * linearFromSrgb(64), kTolerance);
  expectNear(result.sheen, {0.9 * linearFromSrgb(128), 0.5, 0.3}, kTolerance, "sheen color");
  EXPECT_NEAR(double(result.sheen.w), 0.6 * 1, kTolerance);
  EXPECT_NEAR(double(result.film.x), 0, kTolerance);
  EXPECT_NEAR(double(result.glass), 0, kTolerance);
  EXPECT_NEAR(double(result.diffuseTransmission.w), 0.4 * 204 / 255.0, kTolerance);
  expectNear(result.diffuseTransmission, {0.2 * linearFromSrgb(128), 0.5, 1}, kTolerance, "color behind");
  const MaterialResult left = scene.evaluate({caseOf(4, {0.25f, 0})})[0];
  EXPECT_NEAR(double(left.film.x), 0.9 * 7 / 255.0, kTolerance);
  EXPECT_NEAR(double(left.film.y), 1.3, kTolerance);
  EXPECT_NEAR(double(left.film.z), 100 + 300 * 102 / 255.0, 400 * kTolerance);
  EXPECT_NEAR(double(left.glass), 0.75 * 0.5 * 7 / 255.0, kTolerance);
  EXPECT_NEAR(double(left.diffuseTransmission.w), 0.4 * 51 / 255.0, kTolerance);
}

// The coat's own map, of half scale and read through the second uv set, on a base that has another.
TEST(Material, TheClearcoatHasItsOwnNormalMap) {
  const MaterialScene scene;
  const MaterialResult both = scene.evaluate({caseOf(4, {0.25f, 0})})[0];
  expectNear(both.coatNormal, bumpOf(kRightTexel, 0.5), 1e-4, "coat");
  expectNear(both.ns, bumpOf({128, 128, 255}, 1), 1e-4, "base");
  const MaterialResult without = scene.evaluate({caseOf(2, {0.25f, 0})})[0];
  EXPECT_EQ(without.coatNormal, glm::vec3(0, 0, 1)) << "the base's map is not the coat's";
}

TEST(Material, NormalMapOfABackSideIsTheNegativeOfTheFronts) {
  const MaterialScene scene;
  MaterialCase back = caseOf(1, {0.75f, 0});
  back.ng = back.ns = back.wo = {0, 0, -1};
  back.frontFace = 0;
  expectNear(scene.evaluate({back})[0].ns, -bumpOf(kRightTexel, 1), 1e-4, "back");
}

TEST(Material, ShadingNormalIsBentTowardsTheViewer) {
  const MaterialScene scene;
  std::mt19937 generator(1);
  std::normal_distribution<float> normal;
  std::vector<MaterialCase> cases;
  for (int i = 0; i < 2000; ++i) {
    MaterialCase c = caseOf(0, {0.2f, 0.2f});
    const auto direction = [&] {
      return glm::normalize(glm::vec3(normal(generator), normal(generator), normal(generator)));
    };
    c.ng = direction();
    c.ns = direction();
    c.wo = direction();
    if (i % 4 == 0) c.wo = glm::normalize(c.wo - glm::dot(c.wo, c.ng) * c.ng + 0.003f * c.ng); // grazing
    if (glm::dot(c.ng, c.wo) < 0) c.ng = -c.ng;
    if (glm::dot(c.ng, c.ns) < 0) c.ns = -c.ns;
    if (i % 10 == 0) c.ns = c.ng;
    cases.push_back(c);
  }
  const auto results = scene.evaluate(cases);
  int bent = 0;
  for (size_t i = 0; i < cases.size(); ++i) {
    const glm::dvec3 expected =
        oracle::bendTowards(glm::dvec3(cases[i].ns), glm::dvec3(cases[i].ng), glm::dvec3(cases[i].wo));
    expectNear(results[i].ns, expected, 2e-6, "bent");
    EXPECT_GT(glm::dot(glm::dvec3(results[i].ns), glm::dvec3(cases[i].wo)), 0);
    if (cases[i].ns == cases[i].ng) {
      EXPECT_EQ(results[i].ns, cases[i].ng) << "flat surfaces stay flat";
    }
    if (glm::dot(cases[i].ns, cases[i].wo) < 0) ++bent;
  }
  EXPECT_GT(bent, 100);
}

TEST(Material, FeaturesLeaveOutWhatTheyName) {
  const MaterialScene scene;
  const std::vector<gpu::SpecConstant> noTextures{{static_cast<uint32_t>(Feature::kHasTextures), 0},
                                                  {static_cast<uint32_t>(Feature::kHasNormalMaps), 0}};
  const MaterialResult plain = scene.evaluate({caseOf(1, {0.75f, 0})}, noTextures, false)[0];
  expectModel(plain, oracle::metallicRoughness({0.8, 0.2, 0.2}, 0.5, 0.6, 1.4, 0.9, {1, 0.5, 0.25}), 1e-6);
  EXPECT_EQ(plain.ns, glm::vec3(0, 0, 1));
  const std::vector<gpu::SpecConstant> noSpecular{{static_cast<uint32_t>(Feature::kHasSpecular), 0},
                                                  {static_cast<uint32_t>(Feature::kHasMirror), 0},
                                                  {static_cast<uint32_t>(Feature::kHasUnlit), 0}};
  const auto results = scene.evaluate({caseOf(0, {0, 0}), caseOf(3, {0, 0})}, noSpecular);
  EXPECT_EQ(results[0].metallic, 0);
  EXPECT_EQ(results[0].f90, glm::vec3(0));
  EXPECT_EQ(results[1].unlit, 0u);
}
