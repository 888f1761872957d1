// What a depth limit leaves out is measured: image and ledger make the unlimited image, and the image stays what it
// was.
#include <cmath>

#include <gtest/gtest.h>

#include "support/gpu_device.hpp"
#include "support/render.hpp"
#include "support/scenes.hpp"

namespace isophote {
namespace {

using namespace isophote::test;

struct Limited {
  uint32_t depth = 1;
  bool ledger = true;
  bool roulette = true;
  uint32_t side = 8;
};

Image renderLimited(const Scene& scene, const Camera& camera, uint32_t samples, const Limited& limited) {
  const GpuScene gpuScene(gpuDevice(), scene);
  Film film(gpuDevice(), {.width = limited.side, .height = limited.side, .aovs = false, .depthLedger = limited.ledger});
  PathTracer tracer(gpuDevice(), gpuScene,
                    {.filter = PixelFilter::Box,
                     .maxDepth = limited.depth,
                     .russianRoulette = limited.roulette ? RussianRoulette::Root : RussianRoulette::Off,
                     .seed = 3});
  tracer.render(camera, film, {0, samples});
  expectHealthy(tracer.statistics());
  return film.resolve();
}

// A box that emits 1 and reflects 0.5: depth d keeps 2 - 2^-d, the limit takes 2^-d. One path in eight is followed, so
// the ledger is noisier than the image: 64 pixels of 4096 samples see 9% of what is left out after two scatterings. A
// planted factor of 8 that is forgotten, or a bounce counted twice, is off by a half at least.
TEST(DepthLedger, HoldsWhatAnEmittingBoxLosesToTheLimit) {
  for (const uint32_t depth : {0u, 2u}) {
    const Image image =
        renderLimited(boxFurnace(glm::vec3(1), glm::vec3(0.5f)), boxFurnaceCamera(), 4096, {.depth = depth});
    EXPECT_TRUE(pixelMeanIs(image, "G", 2 - std::exp2(-double(depth)), 0.01)) << depth;
    EXPECT_TRUE(pixelMeanIs(image, "beyond.G", std::exp2(-double(depth)), 0.12)) << depth;
  }
}

TEST(DepthLedger, ChangesNoBitOfTheImage) {
  for (const bool roulette : {true, false}) {
    Image with = renderLimited(cornellBox(), cornellCamera(), 16, {.depth = 2, .roulette = roulette});
    const Image without =
        renderLimited(cornellBox(), cornellCamera(), 16, {.depth = 2, .ledger = false, .roulette = roulette});
    EXPECT_GT(with.find("beyond.G")->values.at(0), 0);
    std::erase_if(with.channels, [](const Channel& channel) { return channel.name.starts_with("beyond"); });
    EXPECT_TRUE(bitIdentical(with, without));
  }
}

} // namespace
} // namespace isophote
