// Media in closed meshes. The boundaries here are clear: index 1, all transmitting, so that nothing but the medium acts
// and closed forms are exact.
#include <cmath>
#include <numbers>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "oracle/bsdf_fresnel.hpp"
#include "oracle/medium.hpp"
#include "support/gpu_device.hpp"
#include "support/render.hpp"
#include "support/scenes.hpp"

namespace isophote {
namespace {

using namespace isophote::test;

constexpr uint32_t kSize = 8;

/// A boundary that cannot be seen, around a medium that leaves `color` of white after a unit of length.
Material clearVolume(glm::vec3 color, float distance = 1) {
  Material material = dielectric(glm::vec3(1), 0);
  material.ior = 1;
  material.transmission.factor = 1;
  material.volume = {.thickness = 1, .attenuationColor = color, .attenuationDistance = distance};
  return material;
}

Material scattering(Material material, glm::vec3 multiscatterColor, float g = 0) {
  material.volume.multiscatterColor = multiscatterColor;
  material.volume.scatterAnisotropy = g;
  return material;
}

Scene whiteWorld() {
  Scene scene;
  scene.environment = constantEnvironment(glm::vec3(1));
  return scene;
}

void addBox(Scene& scene, double z0, double z1, const Material& material) {
  addPrimitive(scene, box({-1, -1, z0}, {1, 1, z1}, false, addMaterial(scene, material)));
}

/// Looks along -z, parallel, at the middle of boxes of half width 1.
Camera alongZ(double z) { return orthographicLookAt({0.03, 0.02, z}, {0.03, 0.02, z - 1}, 0.5, 0.5); }

float firstValue(const Image& image, const char* channel) { return plane(image, channel)[0]; }

TEST(RenderMedia, SlabLeavesWhatBeerAndLambertSayFromOpticalDepth1em8To1e4) {
  for (const double depth : {1e-8, 1e-4, 0.01, 0.5, 1.0, 5.0, 20.0, 80.0, 1e4}) {
    Scene scene = whiteWorld();
    // Three channels: half, once and twice the depth over the box's length of 2.
    const glm::vec3 color(glm::exp(glm::dvec3(-0.25, -0.5, -1) * std::min(depth, 60.0)));
    const auto distance = static_cast<float>(std::min(1.0, 60 / depth));
    addBox(scene, -1, 1, clearVolume(color, distance));
    const glm::dvec3 extinction = oracle::mediumCoefficients(scene.materials[0].volume).extinction;
    const Image image = renderImage(scene, alongZ(3), kSize, kSize, 2);
    const char* channels[] = {"R", "G", "B"};
    for (int c = 0; c < 3; ++c) {
      const double expected = std::exp(-2 * extinction[c]);
      for (const float value : plane(image, channels[c]))
        ASSERT_NEAR(value, expected, expected * 8e-7 * (1 + 2 * extinction[c]) + 1e-11) // and the film's quantum, 2^-36
            << depth << " " << c;
    }
  }
}

TEST(RenderMedia, ABlackChannelIsBlackAndAnInfiniteDistanceClear) {
  Scene scene = whiteWorld();
  addBox(scene, -1, 1, clearVolume({0, 1, 0.5f}));
  const Image image = renderImage(scene, alongZ(3), kSize, kSize, 2);
  EXPECT_EQ(firstValue(image, "R"), 0);
  EXPECT_EQ(firstValue(image, "G"), 1);
  EXPECT_NEAR(firstValue(image, "B"), 0.25, 1e-6);
  scene.materials[0].volume.attenuationDistance = 0;
  EXPECT_EQ(firstValue(renderImage(scene, alongZ(3), kSize, kSize, 2), "R"), 1);
}

TEST(RenderMedia, PathLengthIsMeasuredInTheWorldWhateverTheNodesScale) {
  Scene scene = whiteWorld();
  const uint32_t material = addMaterial(scene, clearVolume(glm::vec3(0.5f)));
  addPrimitive(scene, box({-1, -1, -1}, {1, 1, 1}, false, material), glm::scale(glm::dmat4(1), {2, 2, -1.5}));
  EXPECT_NEAR(firstValue(renderImage(scene, alongZ(5), kSize, kSize, 2), "G"), std::pow(0.5, 3), 1e-6);
}

// Boxes [0, 2] and [-1, 1] of the depth 0.3 and 0.7 a unit: between 0 and 1 they overlap.
double overlapped(float priorityFront, float priorityBack, bool reversed = false) {
  Scene scene = whiteWorld();
  Material front = clearVolume(glm::vec3(std::exp(-0.3f)));
  Material back = clearVolume(glm::vec3(std::exp(-0.7f)));
  front.volume.priority = priorityFront;
  back.volume.priority = priorityBack;
  addBox(scene, 0, 2, front);
  addBox(scene, -1, 1, back);
  const Camera camera = reversed ? orthographicLookAt({0.03, 0.02, -3}, {0.03, 0.02, 0}, 0.5, 0.5) : alongZ(3);
  return -std::log(static_cast<double>(firstValue(renderImage(scene, camera, kSize, kSize, 2), "G")));
}

TEST(RenderMedia, TheHigherPriorityFillsAnOverlapFromBothSides) {
  for (const bool reversed : {false, true}) {
    EXPECT_NEAR(overlapped(1, 0, reversed), 2 * 0.3 + 1 * 0.7, 1e-5);
    EXPECT_NEAR(overlapped(-2, 0.5f, reversed), 1 * 0.3 + 2 * 0.7, 1e-5);
  }
  EXPECT_NEAR(overlapped(0, 0), 1 * 0.3 + 2 * 0.7, 1e-5) << "of equal ones the last entered";
}

TEST(RenderMedia, OneMaterialOverlappingItselfIsOneBody) {
  Scene scene = whiteWorld();
  const uint32_t material = addMaterial(scene, clearVolume(glm::vec3(0.5f)));
  addPrimitive(scene, box({-1, -1, 0}, {1, 1, 2}, false, material));
  addPrimitive(scene, box({-1, -1, -1}, {1, 1, 1}, false, material));
  EXPECT_NEAR(firstValue(renderImage(scene, alongZ(3), kSize, kSize, 2), "G"), 0.125, 1e-6);
}

TEST(RenderMedia, NestedVolumesReplaceEachOtherAndAFifthIsCounted) {
  Scene scene = whiteWorld();
  double expected = 0;
  for (int i = 0; i < 4; ++i) { // half lengths 4, 3, 2, 1; the innermost wins
    const double depth = 0.1 * (i + 1);
    const uint32_t material = addMaterial(scene, clearVolume(glm::vec3(static_cast<float>(std::exp(-depth)))));
    addPrimitive(scene, box(glm::dvec3(i - 4), glm::dvec3(4 - i), false, material));
    expected += depth * 2;
  }
  EXPECT_NEAR(-std::log(firstValue(renderImage(scene, alongZ(6), kSize, kSize, 2), "G")), expected, 1e-5);

  addPrimitive(scene,
               box({-0.9, -0.9, -0.5}, {0.9, 0.9, 0.5}, false, addMaterial(scene, clearVolume(glm::vec3(0.5f)))));
  const GpuScene gpuScene(gpuDevice(), scene);
  Film film(gpuDevice(), {.width = 4, .height = 4});
  PathTracer tracer(gpuDevice(), gpuScene);
  tracer.render(alongZ(6), film, {0, 2});
  EXPECT_EQ(tracer.statistics().status.mediumOverflow, 32u);
}

TEST(RenderMedia, CameraInsideKnowsTheMediaAroundIt) {
  Scene scene = whiteWorld();
  Material outer = clearVolume(glm::vec3(std::exp(-0.3f)));
  outer.name = "water";
  Material inner = clearVolume(glm::vec3(std::exp(-0.7f)));
  inner.name = "ice";
  addPrimitive(scene, box(glm::dvec3(-2), glm::dvec3(2), false, addMaterial(scene, outer)));
  addPrimitive(scene, box(glm::dvec3(-1), glm::dvec3(1), false, addMaterial(scene, inner)));
  const struct {
    double z, expected;
    std::vector<std::string> media;
  } cases[] = {{0.5, 1.5 * 0.7 + 0.3, {"water", "ice"}},
               {1.5, 0.5 * 0.3 + 2 * 0.7 + 0.3, {"water"}},
               {3, 2 * 0.3 + 2 * 0.7, {}},
               {-1.5, 0.5 * 0.3, {"water"}}};
  for (const auto& c : cases) {
    const GpuScene gpuScene(gpuDevice(), scene);
    Film film(gpuDevice(), {.width = 4, .height = 4});
    PathTracer tracer(gpuDevice(), gpuScene);
    tracer.render(alongZ(c.z), film, {0, 2});
    expectHealthy(tracer.statistics());
    EXPECT_EQ(tracer.statistics().cameraMedia, c.media);
    EXPECT_NEAR(-std::log(firstValue(film.resolve(), "G")), c.expected, 1e-5) << c.z;
  }
}

// One scattering of a directional light that shines along the view: L = E albedo p(180 degrees) (1 - e^(-2 sigma 2))
// / 2.
TEST(RenderMedia, SingleScatteringMatchesItsIntegral) {
  Scene scene;
  const float g = 0.4f;
  addBox(scene, -1, 1, scattering(clearVolume({0.9f, 0.5f, 0.1f}), {0.9f, 0.6f, 0.3f}, g));
  PunctualLight sun;
  sun.kind = LightKind::Directional;
  sun.intensity = glm::vec3(3);
  sun.direction = {0, 0, -1};
  scene.lights.push_back(sun);
  const oracle::MediumCoefficients medium = oracle::mediumCoefficients(scene.materials[0].volume);
  const EstimatorSettings estimator{.filter = PixelFilter::Box, .maxDepth = 1, .seed = 4};
  const Image image = renderImage(scene, alongZ(3), kSize, kSize, 1024, {.estimator = estimator});
  const char* channels[] = {"R", "G", "B"};
  for (int c = 0; c < 3; ++c) {
    const double expected =
        3 * medium.albedo[c] * oracle::henyeyGreenstein(-1, double(g)) * (1 - std::exp(-4 * medium.extinction[c])) / 2;
    EXPECT_TRUE(pixelMeanIs(image, channels[c], expected, 0.01)) << c;
  }
}

class MediumFurnace : public testing::TestWithParam<LightSampling> {};

// Lossless scattering in a white world: radiance 1 everywhere, whatever the optical depth, anisotropy and color.
TEST_P(MediumFurnace, LosslessScatteringLeavesAWhiteWorldWhite) {
  const struct {
    glm::vec3 color;
    float g;
  } cases[] = {{{0.9f, 0.5f, 0.2f}, 0}, {{0.1f, 0.1f, 0.1f}, 0.8f}, {{0.5f, 1, 0.05f}, -0.6f}};
  for (const auto& c : cases) {
    Scene scene = whiteWorld();
    const uint32_t material = addMaterial(scene, scattering(clearVolume(c.color), glm::vec3(1), c.g));
    addPrimitive(scene, sphere(1, 8, false, false, material));
    const EstimatorSettings estimator{.filter = PixelFilter::Box, .lightSampling = GetParam(), .seed = 5};
    const Image image = renderImage(scene, alongZ(3), kSize, kSize, 64, {.estimator = estimator});
    // The first is thin enough to be seen to 2%; light sampling alone has no use for the phase function.
    for (const char* channel : {"R", "G", "B"})
      EXPECT_TRUE(pixelMeanIs(image, channel, 1, GetParam() == LightSampling::LightsOnly ? 0.3 : 0.1)) << channel;
  }
}

std::string lightSamplingName(const testing::TestParamInfo<LightSampling>& info) {
  const char* const names[] = {"Mis", "LightsOnly", "BsdfOnly"};
  return names[static_cast<size_t>(info.param)];
}

INSTANTIATE_TEST_SUITE_P(RenderMedia, MediumFurnace,
                         testing::Values(LightSampling::Mis, LightSampling::LightsOnly, LightSampling::BsdfOnly),
                         lightSamplingName);

// Optical radius 20 and lossless: hundreds of scatterings, roulette included.
TEST(RenderMedia, DeepRandomWalksKeepTheirEnergy) {
  Scene scene = whiteWorld();
  const uint32_t material = addMaterial(scene, scattering(clearVolume(glm::vec3(std::exp(-20.0f))), glm::vec3(1)));
  addPrimitive(scene, sphere(1, 8, false, false, material));
  const EstimatorSettings estimator{.filter = PixelFilter::Box, .lightSampling = LightSampling::BsdfOnly, .seed = 6};
  EXPECT_TRUE(pixelMeanIs(renderImage(scene, alongZ(3), kSize, kSize, 128, {.estimator = estimator}), "G", 1, 0.02));
}

// A lossless cloud in a closed emitting box changes nothing: Le / (1 - rho) everywhere.
TEST(RenderMedia, ALosslessCloudInTheFurnaceCannotBeSeen) {
  Scene scene = boxFurnace(glm::vec3(1), glm::vec3(0.5f));
  const uint32_t material = addMaterial(scene, scattering(clearVolume({0.1f, 0.3f, 0.9f}), glm::vec3(1), 0.3f));
  addPrimitive(scene, box({-0.5, -0.4, -0.7}, {0.5, 0.4, 0.7}, false, material));
  const Image image = renderImage(scene, boxFurnaceCamera(), 16, 16, 256);
  for (const char* channel : {"R", "G", "B"}) EXPECT_TRUE(pixelMeanIs(image, channel, 2, 0.02)) << channel;
}

// Emission found through a boundary that does nothing is weighed against light sampling from where the path scattered,
// not from the boundary.
TEST(RenderMedia, EmittersBehindClearBoundariesKeepTheirWeights) {
  Scene scene = boxFurnace(glm::vec3(1), glm::vec3(0.5f));
  addPrimitive(scene, box({-0.9, -0.9, -0.9}, {0.9, 0.9, 0.9}, false, addMaterial(scene, clearVolume(glm::vec3(1)))));
  for (const auto sampling : {TriangleLightSampling::Area, TriangleLightSampling::SolidAngle}) {
    const EstimatorSettings estimator{.triangleLightSampling = sampling, .maxDepth = 1};
    const Image image = renderImage(scene, boxFurnaceCamera(), 16, 16, 256, {.estimator = estimator});
    EXPECT_TRUE(pixelMeanIs(image, "G", 1.5, 0.01)) << static_cast<int>(sampling);
  }
}

// A lamp inside absorbing fog lights the floor of it with exactly e^(-sigma d).
TEST(RenderMedia, ShadowRaysInsideAVolumeAreAbsorbed) {
  Scene scene;
  const uint32_t floor = addMaterial(scene, lambert(glm::vec3(1)));
  addPrimitive(scene, facingQuad(4, 4, floor));
  addPrimitive(scene, box({-1, -1, -0.1}, {1, 1, 0.5}, false, addMaterial(scene, clearVolume({0.8f, 0.5f, 1}))));
  PunctualLight sun;
  sun.kind = LightKind::Directional;
  sun.intensity = glm::vec3(float(std::numbers::pi));
  sun.direction = {0, 0, -1};
  scene.lights.push_back(sun);
  const EstimatorSettings estimator{.filter = PixelFilter::Box, .maxDepth = 1, .seed = 4};
  const Image image = renderImage(scene, alongZ(3), kSize, kSize, 2, {.estimator = estimator});
  EXPECT_NEAR(firstValue(image, "R"), 0.8, 1e-5) << "half a unit down and half a unit up";
  EXPECT_NEAR(firstValue(image, "G"), 0.5, 1e-5);
  EXPECT_NEAR(firstValue(image, "B"), 1, 1e-5);
}

// Slabs without end over an emitter of radiance 1: the material of each, and its faces y0 < y1.
struct Slab {
  double y0, y1, ior;
  float priority;
};

Scene slabsOverEmitter(const std::vector<Slab>& slabs) {
  Scene scene;
  constexpr double kHalf = 1e3;
  addPrimitive(scene, quad({-kHalf, 0, kHalf}, {2 * kHalf, 0, 0}, {0, 0, -2 * kHalf},
                           addMaterial(scene, emitter(glm::vec3(1)))));
  for (size_t i = 0; i < slabs.size(); ++i) {
    Material material = glass(0, static_cast<float>(slabs[i].ior));
    material.volume.priority = slabs[i].priority;
    const double half = kHalf - static_cast<double>(i); // sides far away, one inside the other
    addPrimitive(scene,
                 box({-half, slabs[i].y0, -half}, {half, slabs[i].y1, half}, false, addMaterial(scene, material)));
  }
  return scene;
}

// Of a stack of interfaces between lossless media, all orders of reflection summed: R / (1 - R) adds up.
double stackTransmittance(const std::vector<double>& iors, double degrees) {
  const double sine = std::sin(degrees * std::numbers::pi / 180);
  double sum = 0;
  for (size_t i = 0; i + 1 < iors.size(); ++i) {
    const double cosine = std::sqrt(1 - sine * sine / (iors[i] * iors[i]));
    const double reflected = oracle::fresnelDielectric(cosine, iors[i + 1] / iors[i]);
    sum += reflected / (1 - reflected);
  }
  return 1 / (1 + sum);
}

void expectStack(const std::vector<Slab>& slabs, const std::vector<double>& iors) {
  for (const double degrees : {0.0, 60.0}) {
    const double angle = degrees * std::numbers::pi / 180;
    const glm::dvec3 top(0, slabs[0].y1, 0);
    const Camera camera =
        orthographicLookAt(top + 3.0 * glm::dvec3(std::sin(angle), std::cos(angle), 1e-3), top, 0.5, 0.5);
    const Image image = renderImage(slabsOverEmitter(slabs), camera, 16, 16, 256);
    EXPECT_TRUE(pixelMeanIs(image, "G", stackTransmittance(iors, degrees), 0.02)) << degrees;
  }
}

TEST(RenderMedia, NestedDielectricsRefractFromEachIntoTheNext) {
  expectStack({{1, 7, 1.5, 0}, {2, 6, 1.333, 0}, {3, 5, 1.31, 0}}, {1, 1.5, 1.333, 1.31, 1.333, 1.5, 1});
}

// Diamond reaching into water: the overlap is diamond's or water's, and the scene is that of the exact boundaries.
TEST(RenderMedia, OverlappingDielectricsActAsTheirExactBoundaries) {
  expectStack({{2, 4, 1.333, 0}, {1, 3, 2.4, 1}}, {1, 1.333, 2.4, 1});
  expectStack({{2, 4, 1.333, 1}, {1, 3, 2.4, 0}}, {1, 1.333, 2.4, 1});
  // The one within the other, outranked: it is not there at all.
  expectStack({{1, 4, 1.333, 1}, {2, 3, 2.4, 0}}, {1, 1.333, 1});
}

// Milk: lossless scattering behind a refracting boundary, where paths are trapped and leave by roulette or in the end.
TEST(RenderMedia, MilkInAWhiteWorldIsWhite) {
  Scene scene = whiteWorld();
  Material milk = scattering(clearVolume({0.4f, 0.3f, 0.2f}), glm::vec3(1), 0.5f);
  milk.ior = 1.33f;
  addPrimitive(scene, sphere(1, 8, false, false, addMaterial(scene, milk)));
  const Image image = renderImage(scene, alongZ(3), kSize, kSize, 256);
  for (const char* channel : {"R", "G", "B"}) EXPECT_TRUE(pixelMeanIs(image, channel, 1, 0.05)) << channel;
}

TEST(RenderMedia, SpecializedKernelsGiveTheSameBits) {
  Scene scene = whiteWorld();
  const uint32_t cloud = addMaterial(scene, scattering(clearVolume({0.5f, 0.3f, 0.2f}), {0.9f, 0.5f, 0.7f}, 0.5f));
  addPrimitive(scene, sphere(1, 6, true, false, cloud));
  addPrimitive(scene, box({-1, -1, -2}, {0, 0.5, 0}, false, addMaterial(scene, clearVolume({0.5f, 0.9f, 0.9f}))));
  addPrimitive(scene, facingQuad(2, 2, addMaterial(scene, lambert(glm::vec3(0.5f)))),
               glm::translate(glm::dmat4(1), {0, 0, -3}));
  RenderOptions special, general;
  general.execution.specialize = false;
  EXPECT_TRUE(bitIdentical(renderImage(scene, alongZ(3), 16, 16, 16, special),
                           renderImage(scene, alongZ(3), 16, 16, 16, general)));
}

} // namespace
} // namespace isophote
