// The facets and reflectances that the settings choose, rendered: values in closed form, and white surfaces in a white
// world.
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "oracle/bsdf_facets.hpp"
#include "oracle/bsdf_fresnel.hpp"
#include "support/render.hpp"
#include "support/scenes.hpp"

namespace isophote {
namespace {

using namespace isophote::test;

constexpr uint32_t kSize = 4;

Scene planeOf(const Material& material) {
  Scene scene;
  Primitive plane = facingQuad(4, 4, addMaterial(scene, material)); // z = 0, faces +z
  plane.tangents.assign(plane.positions.size(), {1, 0, 0, 1});
  addPrimitive(scene, plane);
  return scene;
}

Camera seenAlong(glm::dvec3 wo) { return orthographicLookAt(8.0 * wo, {0, 0, 0}, 0.1, 0.1); }

struct Choice {
  Ndf ndf = Ndf::Ggx;
  Masking masking = Masking::Correlated;
  Fresnel fresnel = Fresnel::Gltf;
};

EstimatorSettings settingsOf(const Choice& choice) {
  EstimatorSettings estimator{.filter = PixelFilter::Box, .maxDepth = 1, .seed = 3};
  estimator.ndf = choice.ndf;
  estimator.masking = choice.masking;
  estimator.fresnel = choice.fresnel;
  return estimator;
}

/// F D G2 / (4 cos wo) of irradiance 1 from wi.
double reflectedOnce(const Choice& choice, double reflectance, glm::dvec3 wo, glm::dvec3 wi, double alpha) {
  const glm::dvec3 wm = glm::normalize(wo + wi);
  return reflectance * oracle::facetD(choice.ndf, wm, glm::dvec2(alpha)) *
         oracle::facetG2({choice.ndf, choice.masking}, wo, wi, glm::dvec2(alpha)) / (4 * wo.z);
}

const glm::dvec3 kView = glm::normalize(glm::dvec3(0.5, 0.2, 0.6));
const glm::dvec3 kSun = glm::normalize(glm::dvec3(-0.2, 0.1, 0.5));

Scene sunlitPlane(const Material& material) {
  Scene scene = planeOf(material);
  PunctualLight sun;
  sun.kind = LightKind::Directional;
  sun.direction = -kSun;
  scene.lights = {sun};
  return scene;
}

} // namespace

// One reflection of a light without size has no variance: the pixel is the formula.
TEST(RenderFacets, MetalUnderASunIsTheMicrofacetFormula) {
  constexpr double kAlpha = 0.16;
  const Scene scene = sunlitPlane(metal(glm::vec3(1), 0.4f));
  for (const Choice& choice : {Choice{Ndf::Ggx, Masking::Separable}, Choice{Ndf::Beckmann, Masking::Correlated},
                               Choice{Ndf::BlinnPhong, Masking::Separable}}) {
    EstimatorSettings estimator = settingsOf(choice);
    estimator.multipleScattering = false;
    const Image image = renderImage(scene, seenAlong(kView), kSize, kSize, 16, {.estimator = estimator});
    const double expected = reflectedOnce(choice, 1, kView, kSun, kAlpha);
    for (const float value : plane(image, "G")) {
      ASSERT_NEAR(double(value), expected, 1e-4 * expected) << uint32_t(choice.ndf);
    }
  }
}

// A black dielectric has its coat's reflection alone; by the exact equations and by Schlick's approximation they differ
// by a fifth here.
TEST(RenderFacets, PlasticReflectsAsTheSettingFresnelSays) {
  constexpr double kAlpha = 0.16;
  Material plastic = dielectric(glm::vec3(0), 0.4f);
  const glm::dvec3 wo = glm::normalize(glm::dvec3(2, 0, 1)), wi = glm::normalize(glm::dvec3(-2, 0.5, 1));
  Scene scene = sunlitPlane(plastic);
  scene.lights[0].direction = -wi;
  const double cosine = glm::dot(wo, glm::normalize(wo + wi));
  const double schlick = 0.04 + 0.96 * std::pow(1 - cosine, 5);
  for (const auto& [fresnel, reflectance] : {std::pair(Fresnel::Exact, oracle::fresnelDielectric(cosine, 1.5)),
                                             {Fresnel::Gltf, schlick},
                                             {Fresnel::Schlick, schlick}}) {
    const Choice choice{.fresnel = fresnel};
    EstimatorSettings estimator = settingsOf(choice);
    estimator.multipleScattering = false;
    const Image image = renderImage(scene, seenAlong(wo), kSize, kSize, 16, {.estimator = estimator});
    const double expected = reflectedOnce(choice, reflectance, wo, wi, kAlpha);
    for (const float value : plane(image, "G")) {
      ASSERT_NEAR(double(value), expected, 1e-4 * expected) << uint32_t(fresnel);
    }
  }
}

// Test 20 of the reference list for what the settings add: white balls in a white world.
TEST(RenderFacets, Test20LosslessFacetsOfAnySettingAreInvisibleInAFurnace) {
  Scene scene;
  scene.environment = constantEnvironment(glm::vec3(1));
  const Material kinds[] = {metal(glm::vec3(1), 0.7f), dielectric(glm::vec3(1), 0.5f), glass(0.5f), thinGlass(0.7f)};
  for (size_t i = 0; i < std::size(kinds); ++i) {
    addPrimitive(scene, sphere(1, 12, false, false, addMaterial(scene, kinds[i])),
                 glm::translate(glm::dmat4(1), glm::dvec3(2.0 * double(i) - 3, 0, 0)));
  }
  constexpr uint32_t kCell = 8;
  const Camera camera = orthographicLookAt({0, 0, 10}, {0, 0, 0}, 4, 1);
  for (const Choice& choice : {Choice{Ndf::Beckmann, Masking::Correlated, Fresnel::Exact},
                               Choice{Ndf::BlinnPhong, Masking::Separable, Fresnel::Schlick}}) {
    EstimatorSettings estimator = settingsOf(choice);
    estimator.maxDepth = kUnlimitedDepth;
    estimator.lightSampling = LightSampling::BsdfOnly;
    const Image image = renderImage(scene, camera, 4 * kCell, kCell, 1024, {.estimator = estimator});
    const std::vector<float> values = plane(image, "G");
    for (uint32_t column = 0; column < 4; ++column) {
      Moments cell;
      for (uint32_t i = 0; i < kCell * kCell; ++i) {
        cell.add(double(values[i / kCell * 4 * kCell + column * kCell + i % kCell]));
      }
      EXPECT_LT(cell.standardError(), 0.007) << column;
      EXPECT_NEAR(cell.mean(), 1, 0.01 + 2 * cell.standardError()) << column << ", ndf " << uint32_t(choice.ndf);
    }
  }
}

// A brushed white metal, along and across, near and far from the horizon; what it loses between facets is tabulated for
// the material, or for the range that its textures can give.
TEST(RenderFacets, Test20BrushedMetalIsInvisibleInAFurnace) {
  for (const bool textured : {false, true}) {
    Material brushed = metal(glm::vec3(1), 0.3f);
    brushed.anisotropy.strength = 0.9f;
    Scene scene = planeOf(brushed);
    scene.environment = constantEnvironment(glm::vec3(1));
    if (textured) {
      const uint32_t white = addTexture(scene, 1, 1, {{255, 128, 255, 255}}, Filter::Nearest, Wrap::Repeat);
      scene.materials[0].anisotropy.texture = useTexture(white);
    }
    for (const glm::dvec3& view : {glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 0.2), glm::dvec3(0, 1, 0.2)}) {
      EstimatorSettings estimator = settingsOf({});
      estimator.lightSampling = LightSampling::BsdfOnly;
      const Image image = renderImage(scene, seenAlong(glm::normalize(view)), 8, 8, 512, {.estimator = estimator});
      EXPECT_TRUE(pixelMeanIs(image, "G", 1, 0.01)) << view.x << view.y << textured;
    }
  }
}

} // namespace isophote
