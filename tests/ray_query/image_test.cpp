// Whole renders by both backends.
#include <gtest/gtest.h>

#include "ray_query/ray_query_device.hpp"
#include "support/render.hpp"
#include "support/scenes.hpp"

using namespace isophote;

namespace {

constexpr uint32_t kSide = 24;

Image render(const Device& device, const Scene& scene, const Camera& camera, Backend backend, uint32_t samples,
             uint64_t seed, Pipeline pipeline = Pipeline::Wavefront) {
  const GpuScene onDevice(device, scene, backend);
  Film film(device, {.width = kSide, .height = kSide});
  PathTracer tracer(device, onDevice, {.filter = PixelFilter::Box, .seed = seed}, {.pipeline = pipeline});
  tracer.render(camera, film, {0, samples});
  test::expectHealthy(tracer.statistics());
  return film.resolve();
}

/// Channels of the image that differ in any bit.
uint32_t differing(const Image& a, const Image& b) {
  uint32_t count = 0;
  for (const char* channel : {"R", "G", "B"}) {
    const std::vector<float> first = test::plane(a, channel), second = test::plane(b, channel);
    for (size_t i = 0; i < first.size(); ++i) count += first[i] != second[i];
  }
  return count;
}

} // namespace

using RayQueryImage = test::RayQueryTest;

// One mesh group: the same triangles, instance and random numbers. Only a ray within rounding of an edge can differ.
TEST_F(RayQueryImage, OfOneInstanceIsThatOfTheOwnBvhToTheBit) {
  const Scene scene = test::cornellBox();
  const Image own = render(device(), scene, test::cornellCamera(), Backend::Compute, 16, 1);
  const Image query = render(device(), scene, test::cornellCamera(), Backend::RayQuery, 16, 1);
  EXPECT_LE(differing(own, query), 3u * kSide * kSide / 100);
}

TEST_F(RayQueryImage, OfTheFusedKernelIsThatOfTheWavefrontToTheBit) {
  const Scene scene = test::texturedStillLife();
  const Camera camera = test::texturedStillLifeCamera();
  const Image wavefront = render(device(), scene, camera, Backend::RayQuery, 8, 1);
  const Image fused = render(device(), scene, camera, Backend::RayQuery, 8, 1, Pipeline::Fused);
  EXPECT_TRUE(test::bitIdentical(wavefront, fused));
}

// Other orders of instances and lights are other random numbers: Welch's tests of independent renders.
TEST_F(RayQueryImage, OfTexturesMasksAndBlendsIsTheSameWithinNoise) {
  const Scene scene = test::texturedStillLife();
  const Image own = render(device(), scene, test::texturedStillLifeCamera(), Backend::Compute, 256, 1);
  const Image query = render(device(), scene, test::texturedStillLifeCamera(), Backend::RayQuery, 256, 2);
  EXPECT_TRUE(test::sameImage(test::measured(own), test::measured(query), {.powerFloor = 0.02}));
}

TEST_F(RayQueryImage, OfManyInstancesIsTheSameWithinNoise) {
  const Scene scene = test::instanceGrid();
  const Image own = render(device(), scene, test::instanceGridCamera(), Backend::Compute, 256, 1);
  const Image query = render(device(), scene, test::instanceGridCamera(), Backend::RayQuery, 256, 2);
  EXPECT_TRUE(test::sameImage(test::measured(own), test::measured(query), {.powerFloor = 0.02}));
}

TEST_F(RayQueryImage, OfASphereLightHasItsClosedForm) {
  const Scene scene = test::floorUnderASphere(0.5f);
  const Image image = render(device(), scene, test::sensorAt({0, 0, 0}), Backend::RayQuery, 64, 1);
  EXPECT_TRUE(test::pixelMeanIs(image, "R", 0.25));
}

// A ray that slips out at an edge, or that meets the wall it has just left, would change the radiance of a closed room.
TEST_F(RayQueryImage, OfAFurnaceLosesNothing) {
  const Scene scene = test::boxFurnace(glm::vec3(0.5f), glm::vec3(0.5f));
  const Image image = render(device(), scene, test::boxFurnaceCamera(), Backend::RayQuery, 256, 1);
  EXPECT_TRUE(test::pixelMeanIs(image, "G", 1.0));
}
