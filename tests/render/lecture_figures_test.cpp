// The pictures of the course that the project grew from (PA213, "Monte Carlo Rendering", after K. Crane), one by one:
// each with the settings that make it, held to the image of the default settings, and to the noise that the course
// shows.
//
// Where the course's own formula is wrong (docs/bsdf.md, "Direction sampling") the picture is the right one.
#include <cmath>
#include <map>
#include <numbers>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "support/render.hpp"
#include "support/scenes.hpp"
#include "support/statistics.hpp"

namespace isophote {
namespace {

using namespace isophote::test;

constexpr uint32_t kWidth = 24;
constexpr uint32_t kHeight = 16;
constexpr uint32_t kReferenceSamples = 512;

/// Each block's mean of a quiet image is known to this share or better: enough to see a factor of 2 or pi forgotten.
constexpr double kFigurePower = 0.5;

/// Three spheres of one material under a round lamp that is out of view, on a gray floor in front of a red wall; or all
/// of that material.
Scene courseScene(const Material& material, float lamp = 6, bool everywhere = false) {
  Scene scene;
  const uint32_t floor = addMaterial(scene, everywhere ? material : lambert(glm::vec3(0.6f)));
  const uint32_t wall = addMaterial(scene, everywhere ? material : lambert({0.7f, 0.2f, 0.2f}));
  const uint32_t light = addMaterial(scene, emitter(glm::vec3(lamp)));
  const uint32_t ball = addMaterial(scene, material);
  addPrimitive(scene, quad({-3, 0, 2}, {6, 0, 0}, {0, 0, -4}, floor));
  addPrimitive(scene, quad({-3, 0, -2}, {6, 0, 0}, {0, 4, 0}, wall));
  addPrimitive(scene, sphere(0.8, 6, true, false, light), glm::translate(glm::dmat4(1), glm::dvec3(0, 3.2, 0.8)));
  for (const double x : {-1.3, 0.0, 1.3}) {
    addPrimitive(scene, sphere(0.6, 10, true, false, ball), glm::translate(glm::dmat4(1), glm::dvec3(x, 0.6, 0)));
  }
  return scene;
}

Camera courseCamera() { return lookAt({0, 1.5, 5}, {0, 0.9, 0}, 0.6); }

struct Figure {
  uint32_t samples = 100;
  uint32_t bounces = 10;
  DirectionSampling directions = DirectionSampling::Lobes;
  LightSampling lights = LightSampling::BsdfOnly; // the course's pictures find lights by chance until its last chapter
  Ndf ndf = Ndf::Ggx;
  Masking masking = Masking::Correlated;
  Fresnel fresnel = Fresnel::Gltf;
};

Image render(const Scene& scene, const Figure& figure) {
  EstimatorSettings estimator{.filter = PixelFilter::Box, .seed = 7};
  estimator.lightSampling = figure.lights;
  estimator.lightSelection = LightSelection::Uniform; // "when lights are picked uniformly"
  estimator.maxDepth = figure.bounces;
  estimator.directionSampling = figure.directions;
  estimator.ndf = figure.ndf;
  estimator.masking = figure.masking;
  estimator.fresnel = figure.fresnel;
  return renderImage(scene, courseCamera(), kWidth, kHeight, figure.samples, {.estimator = estimator});
}

/// The figure's own surface, by the default's sampling.
Image reference(const Scene& scene, Figure figure) {
  figure.samples = kReferenceSamples;
  figure.directions = DirectionSampling::Lobes;
  figure.lights = LightSampling::Mis;
  return render(scene, figure);
}

Image reference(const Scene& scene, uint32_t bounces) { return reference(scene, Figure{.bounces = bounces}); }

/// Mean variance of the pixels' means, all channels.
double noise(const Image& image) {
  double sum = 0;
  for (const char* channel : {"R", "G", "B"}) {
    for (const float error : plane(image, std::string("stderr.") + channel)) sum += double(error) * double(error);
  }
  return sum / (3.0 * kWidth * kHeight);
}

/// z-tests of the means of blocks of 8 x 8 pixels, whose 64 independent estimates are near enough to normal where
/// single pixels that found the lamp twice or never are not. Significance: one of kTestFamily, over blocks and
/// channels.
void expectSame(const Image& image, const Image& expected, double powerFloor = kFigurePower) {
  constexpr uint32_t kSide = 8;
  constexpr uint32_t kBlocks = (kWidth / kSide) * (kHeight / kSide);
  const double critical = normalTwoSidedQuantile(sidak(testSignificance(), 3 * kBlocks));
  for (const char* channel : {"R", "G", "B"}) {
    const std::string errors = std::string("stderr.") + channel;
    const std::vector<float> a = plane(image, channel), b = plane(expected, channel);
    const std::vector<float> errorA = plane(image, errors), errorB = plane(expected, errors);
    for (uint32_t block = 0; block < kBlocks; ++block) {
      double sumA = 0, sumB = 0, variance = 0;
      for (uint32_t i = 0; i < kSide * kSide; ++i) {
        const uint32_t x = block % (kWidth / kSide) * kSide + i % kSide,
                       y = block / (kWidth / kSide) * kSide + i / kSide;
        const size_t pixel = size_t{y} * kWidth + x;
        sumA += double(a[pixel]);
        sumB += double(b[pixel]);
        variance += double(errorA[pixel]) * double(errorA[pixel]) + double(errorB[pixel]) * double(errorB[pixel]);
      }
      const double bound = critical * std::sqrt(variance) + kRounding * sumB;
      EXPECT_LE(std::abs(sumA - sumB), bound) << channel << " of block " << block << ": " << sumA << ", not " << sumB;
      EXPECT_LE(bound, powerFloor * sumB) << channel << " of block " << block << " is not known well enough";
    }
  }
}

/// Two figures of one scene: both show what the reference shows, and the better one has less than `ratio` of the
/// other's variance. The noisy one is held to its own error only.
void expectLessNoise(const Scene& scene, const Figure& better, const Figure& worse, double ratio) {
  const Image expected = reference(scene, better.bounces);
  const Image quiet = render(scene, better);
  const Image loud = render(scene, worse);
  expectSame(quiet, expected);
  expectSame(loud, expected, 1e9);
  EXPECT_LT(noise(quiet), ratio * noise(loud));
}

const Material kLambert = lambert(glm::vec3(0.8f));
/// The course's roughness is the width alpha, glTF's its root.
Material courseMetal(float alpha) { return metal({0.9f, 0.8f, 0.6f}, std::sqrt(alpha)); }
Material coursePlastic(float alpha) { return dielectric({0.2f, 0.4f, 0.8f}, std::sqrt(alpha)); }

} // namespace

// "f = 1, n = 100 and n = 1000, p = 1 / 2 pi": ten times the samples, a tenth of the variance.
TEST(LectureFigures, DirectLightByUniformDirectionsWithHundredAndThousandSamples) {
  const Figure hundred{.samples = 100, .bounces = 1, .directions = DirectionSampling::Uniform};
  Figure thousand = hundred;
  thousand.samples = 1000;
  expectLessNoise(courseScene(kLambert), thousand, hundred, 0.2);
}

// "Comparison: p = 1 / 2 pi, p = cos / pi".
TEST(LectureFigures, DirectLightByCosineAgainstUniformDirections) {
  const Figure cosine{.samples = 400, .bounces = 1, .directions = DirectionSampling::Cosine};
  Figure uniform = cosine;
  uniform.directions = DirectionSampling::Uniform;
  expectLessNoise(courseScene(kLambert), cosine, uniform, 1);
}

// "f = rho against f = rho / pi": a surface of f = rho would reflect pi times what it receives and is not offered; its
// picture is that of a lamp pi times as bright, to rounding.
TEST(LectureFigures, LambertWithAndWithoutItsPi) {
  const Figure figure{.bounces = 1, .directions = DirectionSampling::Cosine};
  const Image right = render(courseScene(kLambert, 1), figure);
  const Image without = render(courseScene(kLambert, std::numbers::pi_v<float>), figure);
  for (const char* channel : {"R", "G", "B"}) {
    const std::vector<float> a = plane(right, channel);
    const std::vector<float> b = plane(without, channel);
    for (size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(b[i], std::numbers::pi * a[i], 1e-4 * b[i] + 1e-6);
  }
}

// "Gamma OFF, gamma ON": x^(1/2.2), and the curve of sRGB that it approximates, against none.
TEST(LectureFigures, GammaCorrectionOnAndOff) {
  const Image image = render(courseScene(kLambert), {.bounces = 1, .directions = DirectionSampling::Cosine});
  const std::vector<float> radiance = plane(image, "G");
  for (const float value : radiance) {
    const float off = toneMap(glm::vec3(value), ToneMap::Linear).g;
    const float on = toneMap(glm::vec3(value), ToneMap::Srgb, Transfer::Gamma22).g;
    const float srgb = toneMap(glm::vec3(value), ToneMap::Srgb).g;
    EXPECT_NEAR(on, std::pow(std::min(double(value), 1.0), 1 / 2.2), 1e-5);
    EXPECT_GE(on, off);
    EXPECT_NEAR(on, srgb, 8.6 / 255); // largest distance of the two curves
  }
}

// "Path tracing, bounces = 10: p = 1 / 2 pi, p = cos / pi".
TEST(LectureFigures, PathsOfTenBouncesByCosineAgainstUniformDirections) {
  const Figure cosine{.samples = 400, .directions = DirectionSampling::Cosine};
  Figure uniform = cosine;
  uniform.directions = DirectionSampling::Uniform;
  expectLessNoise(courseScene(kLambert), cosine, uniform, 1);
}

// "Microfacet model BRDF, roughness = 0.2: p = cos / pi, p = D cos / (4 wo.wh)".
TEST(LectureFigures, MicrofacetsByTheirNormalsAgainstCosine) {
  const Figure ndf{.samples = 800, .directions = DirectionSampling::Ndf};
  Figure cosine = ndf;
  cosine.directions = DirectionSampling::Cosine;
  expectLessNoise(courseScene(courseMetal(0.2f), 6, true), ndf, cosine, 1);
}

// "Comparison, roughness = 1.0" of GGX and "f = rho / pi".
TEST(LectureFigures, RoughestMicrofacetsAndLambert) {
  const Scene rough = courseScene(courseMetal(1));
  const Image ggx = render(rough, {.samples = 400, .directions = DirectionSampling::Ndf});
  expectSame(ggx, reference(rough, 10));
  const Scene diffuse = courseScene(kLambert);
  const Image lambertian = render(diffuse, {.samples = 400, .directions = DirectionSampling::Cosine});
  expectSame(lambertian, reference(diffuse, 10));
}

// "Combining BRDFs: GGX only, GGX + cosine", of a surface that has both; the mixture's densities are all evaluated.
TEST(LectureFigures, GgxAndCosineAgainstGgxAlone) {
  const Figure both{.samples = 400, .directions = DirectionSampling::Mixture};
  Figure alone = both;
  alone.directions = DirectionSampling::Ndf;
  expectLessNoise(courseScene(coursePlastic(0.2f)), both, alone, 1);
}

// "GGX + cosine, GGX + cosine + lights".
TEST(LectureFigures, LightSamplingBesideGgxAndCosine) {
  const Figure with{.samples = 200, .directions = DirectionSampling::Mixture, .lights = LightSampling::Mis};
  Figure without = with;
  without.lights = LightSampling::BsdfOnly;
  expectLessNoise(courseScene(coursePlastic(0.2f)), with, without, 0.7);
}

// "Result: n = 1000, r = 0.2" and "r = 0.8": rough glass over the diffuse floor, by half lobes and half mixture.
TEST(LectureFigures, GlassOfRoughnessTwoAndEightTenths) {
  for (const float alpha : {0.2f, 0.8f}) {
    Material glass = coursePlastic(alpha);
    glass.baseColor = glm::vec4(1);
    glass.transmission.factor = 1;
    glass.volume.thickness = 1; // solid: it refracts
    const Scene scene = courseScene(glass);
    const Image image = render(scene, {.samples = 4000, .directions = DirectionSampling::Mixture});
    SCOPED_TRACE(alpha);
    expectSame(image, reference(scene, 10));
  }
}

// "Normal distribution function: Beckmann, Blinn": as distributions whose integral of D cos is 1, drawn by themselves.
TEST(LectureFigures, MicrofacetsOfBeckmannAndBlinn) {
  for (const Ndf ndf : {Ndf::Beckmann, Ndf::BlinnPhong}) {
    SCOPED_TRACE(uint32_t(ndf));
    const Scene scene = courseScene(courseMetal(0.2f));
    const Figure figure{.samples = 800, .directions = DirectionSampling::Ndf, .ndf = ndf};
    expectSame(render(scene, figure), reference(scene, figure));
  }
}

// "Geometric attenuation: multiple models exist". The course's, Smith's of GGX with 2 cos cos over a sum, is the
// default, correlated by height; the other is the product of both maskings.
TEST(LectureFigures, SeparableMasking) {
  const Scene scene = courseScene(courseMetal(0.8f));
  const Figure figure{.samples = 400, .directions = DirectionSampling::VisibleNormals, .masking = Masking::Separable};
  expectSame(render(scene, figure), reference(scene, figure));
}

// "Transmission: prob = F(((n1 - n2) / (n1 + n2))^2)": smooth glass by Snell's law and Schlick's approximation, its
// cosine that of the less dense side, and by the Fresnel equations. The pictures differ by less than a twentieth.
TEST(LectureFigures, SmoothGlassBySchlickAndByFresnel) {
  Material glass = coursePlastic(0);
  glass.baseColor = glm::vec4(1);
  glass.transmission.factor = 1;
  glass.volume.thickness = 1;
  const Scene scene = courseScene(glass);
  const Figure schlick{.samples = 2000, .fresnel = Fresnel::Schlick};
  Figure exact = schlick;
  exact.fresnel = Fresnel::Exact;
  const Image bySchlick = render(scene, schlick), byFresnel = render(scene, exact);
  expectSame(bySchlick, reference(scene, schlick));
  expectSame(byFresnel, reference(scene, exact));
  double sum = 0, difference = 0;
  const std::vector<float> a = plane(bySchlick, "G"), b = plane(byFresnel, "G");
  for (size_t i = 0; i < a.size(); ++i) {
    sum += double(b[i]);
    difference += double(a[i]) - double(b[i]);
  }
  EXPECT_LT(std::abs(difference), 0.05 * sum);
}

// The round lamp by a point on its area, with the cosine that the course leaves out, and by chance.
TEST(LectureFigures, RoundLampBySamplingItsArea) {
  const Figure area{.samples = 200, .bounces = 1, .lights = LightSampling::LightsOnly};
  Figure chance = area;
  chance.lights = LightSampling::BsdfOnly;
  expectLessNoise(courseScene(kLambert), area, chance, 0.5);
}

} // namespace isophote
