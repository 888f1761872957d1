// Samples where the error is: as many as asked for in each pixel, and no bias from choosing by a pilot of other
// samples.
#include <gtest/gtest.h>

#include "isophote/sample_allocation.hpp"
#include "support/gpu_device.hpp"
#include "support/render.hpp"
#include "support/scenes.hpp"

namespace isophote {
namespace {

using namespace isophote::test;

TEST(Adaptive, APixelListGivesThosePixelsTheirSamplesBitForBit) {
  const GpuScene scene(gpuDevice(), cornellBox());
  PathTracer tracer(gpuDevice(), scene);
  Film whole(gpuDevice(), {.width = 8, .height = 6}), parts(gpuDevice(), {.width = 8, .height = 6});
  tracer.render(cornellCamera(), whole, {0, 8});
  std::vector<uint32_t> odd, even;
  for (uint32_t i = 0; i < 48; ++i) (i % 2 == 1 ? odd : even).push_back(i);
  tracer.setPixels(odd);
  tracer.render(cornellCamera(), parts, {0, 8});
  for (uint32_t i = 0; i < 48; ++i) EXPECT_EQ(parts.resolve().find("sampleCount.Y")->values[i], i % 2 == 1 ? 8 : 0);
  tracer.setPixels(even);
  tracer.render(cornellCamera(), parts, {0, 8});
  EXPECT_TRUE(bitIdentical(whole.resolve(), parts.resolve()));
  expectHealthy(tracer.statistics());
}

// A small sphere, which directions by chance find one in a hundred times. A million samples: the mean is known to 6%. A
// pilot that were part of the image would make it darker by about that much: where it saw no light, the image would
// keep the pilot's darkness among few samples.
TEST(Adaptive, AChoiceByOtherSamplesHasNoBias) {
  constexpr uint32_t kSide = 64;
  const GpuScene scene(gpuDevice(), floorUnderASphere(0.2f));
  PathTracer tracer(gpuDevice(), scene,
                    {.filter = PixelFilter::Box, .lightSampling = LightSampling::BsdfOnly, .maxDepth = 1});
  Film film(gpuDevice(), {.width = kSide, .height = kSide, .aovs = false});
  Moments adaptive, reusing;
  for (uint64_t seed = 0; seed < 8; ++seed) {
    film.clear();
    tracer.setPixels({});
    tracer.setSeed(1000 + seed);
    tracer.render(sensorAt({0, 0, 0}), film, {0, 8});
    const std::vector<float> pilot = plane(film.resolve(), "G");
    const SampleAllocation allocation = allocateSamples(film.resolve());
    film.clear();
    tracer.setSeed(seed);
    for (uint32_t c = 0; c < SampleAllocation::kClasses; ++c) {
      if (allocation.pixels[c].empty()) continue;
      tracer.setPixels(allocation.pixels[c]);
      tracer.render(sensorAt({0, 0, 0}), film, {0, 8 * SampleAllocation::weight(c)});
    }
    const Image image = film.resolve();
    const std::vector<float> values = plane(image, "G"), counts = plane(image, "sampleCount.Y");
    for (size_t i = 0; i < values.size(); ++i) {
      adaptive.add(double(values[i]));
      reusing.add((8 * double(pilot[i]) + double(counts[i]) * double(values[i])) / (8 + double(counts[i])));
    }
  }
  EXPECT_TRUE(meanIs(adaptive, 0.25, 0.08));
  EXPECT_LT(meanTest(reusing, 0.25), testSignificance()) << "a pilot that is reused is not seen: " << reusing.mean();
}

} // namespace
} // namespace isophote
